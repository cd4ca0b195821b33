#include <gtest/gtest.h>

#include "harness/catalogue/catalogue.hpp"
#include "harness/config/read_sweep.hpp"
#include "tests/support/refusal_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::calibration_test {

using namespace harness;

namespace {

class CalibrationFile : public testing::Test {
 protected:
  CalibrationFile() {
    folder_.file("learnt.yaml",
                 "trained_on: [\"drawn 1\"]\n"
                 "trained_on_sources: [\"reference:01\", \"noise:02\"]\n"
                 "motion_drift:\n"
                 "  noise.t.per_metre: 0.002  # 90 %: 0.001 .. 0.003\n"
                 "  drift.r.per_metre: 0\n");
  }

  Sweep parse(const std::string& entry) const {
    return parse_sweep(
        "datasets: [{dataset: simulated}]\nmethods:\n  - " + entry + "\nmetrics: [ate]\n",
        folder_.path() / "c.yaml",
        catalogue({}));
  }

  TemporaryFolder folder_;
};

TEST_F(CalibrationFile, GivesOptionsThatTheEntryDoesNotSet) {
  const Sweep sweep =
      parse("{method: motion_drift + polyline, calibration: learnt.yaml, noise.t.per_metre: 0.5}");
  const MethodChoice& method = sweep.methods[0];
  const Params& options = method.stages[0].options;
  EXPECT_EQ(options.at("noise.t.per_metre"), Param(0.5));
  EXPECT_EQ(options.size(), 2u);
  EXPECT_TRUE(method.stages[1].options.empty());
  EXPECT_EQ(method.label, "motion_drift + polyline (noise.t.per_metre=0.5)");
  EXPECT_EQ(method.trained_on.calibration, "learnt.yaml");
  EXPECT_EQ(method.trained_on.labels, std::vector<std::string>{"drawn 1"});
  EXPECT_EQ(method.trained_on.sources, (std::vector<std::string>{"reference:01", "noise:02"}));
}

TEST_F(CalibrationFile, MustExistAndHaveValuesOfTheMethod) {
  const auto why = [&](const std::string& entry) { return refusal_of([&] { parse(entry); }); };
  EXPECT_NE(why("{method: dual, calibration: learnt.yaml}").find("has no values for dual"),
            std::string::npos);
  EXPECT_NE(why("{method: motion_drift, calibration: lost.yaml}").find("c.yaml:3: calibration:"),
            std::string::npos);
}

}  // namespace
}  // namespace loopbench::calibration_test
