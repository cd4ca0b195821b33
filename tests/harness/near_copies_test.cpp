/// Sequences of a sweep whose references are near-copies of one recording are one observation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/command.hpp"

namespace loopbench::near_copies_test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Poses on a curved path. `noise` moves every other position [m].
std::string path_of(int poses, double scale, double noise, double drift = 0.0, double bend = 0.11) {
  std::string out;
  for (int i = 0; i < poses; ++i) {
    const double angle = bend * i;
    const double offset = i % 2 == 0 ? noise : -noise;
    out += std::to_string(0.5 * i) + " " +
           std::to_string(scale * (10.0 * std::sin(angle) + drift * i) + offset) + " " +
           std::to_string(scale * 7.0 * (1.0 - std::cos(1.7 * angle))) + " " +
           std::to_string(scale * 0.02 * i) + " 0 0 0 1\n";
  }
  return out;
}

class NearCopies : public testing::Test {
 protected:
  void add(const std::string& name, const std::string& reference, double drift) {
    folder_.file(name + "_est.txt", path_of(60, 1.0, 0.0, drift));
    folder_.file(name + "_ref.txt", reference);
    datasets_ += "  - {dataset: trajectory, label: " + name + ", estimate: " + name +
                 "_est.txt, reference: " + name + "_ref.txt}\n";
  }

  std::string compared() {
    folder_.file("c.yaml",
                 "datasets:\n" + datasets_ +
                     "methods: [raw, {method: cubic_spline, label: spline}]\n"
                     "metrics: [ate]\ntimes: keyframes\n");
    const CommandResult ran = loopbench_command("run c.yaml --out r", folder_);
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    return loopbench_command("compare r --where unit=m", folder_).out;
  }

  TemporaryFolder folder_;
  std::string datasets_;
};

TEST_F(NearCopies, CroppedScaledAndNoisyReferencesAreOneGroup) {
  add("whole", path_of(60, 1.0, 0.0), 0.01);
  add("cropped", path_of(45, 1.0, 0.0), 0.02);
  add("scaled", path_of(60, 1.001, 0.0), 0.03);
  add("noisy", path_of(60, 1.0, 0.002), 0.04);
  const std::string out = compared();
  EXPECT_THAT(out, HasSubstr("over 1 group (4 runs)"));
  EXPECT_THAT(out,
              HasSubstr("the references are one recording (guessed from their geometry unless a "
                        "group is stated): cropped of whole, noisy of whole, scaled of whole"));
}

TEST_F(NearCopies, OtherPathsAreOtherGroups) {
  add("one", path_of(60, 1.0, 0.0), 0.01);
  add("other", path_of(60, 1.0, 0.0, 0.0, 0.13), 0.02);
  const std::string out = compared();
  EXPECT_THAT(out, HasSubstr("2 sequences"));
  EXPECT_THAT(out, Not(HasSubstr("one recording")));
}

}  // namespace
}  // namespace loopbench::near_copies_test
