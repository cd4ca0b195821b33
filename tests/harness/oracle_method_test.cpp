#include "harness/execution/run/oracle_method.hpp"

#include <gtest/gtest.h>

#include <atomic>

#include "harness/catalogue/load_sequence.hpp"
#include "harness/config/read_sweep.hpp"
#include "harness/execution/isolate/isolated_sweep.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::oracle_method_test {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

SequenceMetadata with_source(const std::string& source) {
  SequenceMetadata out;
  out.source = source;
  out.group = "group:other";
  return out;
}

TEST(OracleMethod, IsOneTrainedOnTheEvaluatedReference) {
  MethodChoice method{"learnt", {}, {"c.yaml", {"kitti 06"}, {"reference:06", "reference:07"}}};
  const auto why = [&](const std::string& label, const std::string& source) {
    return trained_on_evaluated(method, {label, {}}, with_source(source));
  };
  EXPECT_EQ(why("another name", "reference:07"),
            "c.yaml was trained on the reference of this sequence");
  EXPECT_EQ(why("kitti 06", "reference:00"), "");  // the label alone is no evidence
  SequenceMetadata read = with_source("reference:shape");
  read.inputs = {{"reference", "gt.txt", 10, "06"}};  // hash of its bytes, in older calibrations
  EXPECT_EQ(trained_on_evaluated(method, {"another name", {}}, read),
            "c.yaml was trained on the reference of this sequence");
  method.trained_on.sources.clear();  // a file of an older version
  EXPECT_EQ(why("kitti 06", "reference:00"), "c.yaml was trained on a dataset with this label");
  EXPECT_EQ(why("another name", "reference:06"), "");
  method.trained_on = {};
  EXPECT_EQ(why("kitti 06", "reference:06"), "");
}

TEST(OracleMethod, OfATrainedCalibrationIsMarkedInItsCells) {
  const TemporaryFolder folder;
  const Catalogue known = catalogue({});
  const auto sweep_with = [&](const std::string& sources) {
    folder.file("learnt.yaml",
                "trained_on: [\"a\"]\ntrained_on_sources: [" + sources +
                    "]\nmotion_drift:\n  noise.t.per_metre: 0.001\n");
    return parse_sweep(
        "datasets: [{dataset: simulated, keyframes: 40}]\n"
        "methods: [raw, {method: motion_drift, label: learnt, calibration: learnt.yaml}]\n"
        "metrics: [ate]\nrepeats: 2\n",
        folder.path() / "c.yaml",
        known);
  };
  Sweep sweep = sweep_with("");
  const std::vector<Cell> all = cells(sweep, seeded(sweep, known), "");
  const std::string source =
      metadata_of(load_sequence(all[0], sweep, known, {}), all[0], sweep).source;
  sweep = sweep_with("\"" + source + "\"");
  ASSERT_EQ(sweep.methods[1].trained_on.sources, std::vector{source});

  const StopRequests stop = 0;
  const auto check_all = [&](const auto& run) {
    std::size_t seen = 0;
    run([&](const CellResult& result) {
      ++seen;
      const bool trained = result.cell.method == 1 && result.cell.repeat == 0;
      EXPECT_EQ(result.oracle_method, trained) << result.cell.index;
      const auto& notes = result.report.notes;
      const bool noted = !notes.empty() && notes.back().starts_with("oracle: learnt.yaml");
      EXPECT_EQ(noted, trained);
    });
    EXPECT_EQ(seen, 4u);
  };
  check_all([&](const auto& finished) { run_here(sweep, all, known, {}, finished); });
  check_all(
      [&](const auto& finished) { run_isolated(sweep, all, known, {}, 1, {}, stop, finished); });
}

}  // namespace
}  // namespace loopbench::oracle_method_test
