/// Methods whose results differ between runs on the same input are reported.
#include <gmock/gmock.h>

#include "harness/store/read.hpp"
#include "tests/support/tiny_store.hpp"

namespace loopbench::nondeterminism_test {

using namespace methods;
using namespace harness;

namespace {

using namespace tiny_store;  // NOLINT: the fixture

/// Moves the second keyframe by the last digits of a number that grows with each run.
struct Unsteady final : Corrector {
  explicit Unsteady(double step_size) : step(step_size) {}
  Trajectory correct(const Problem& problem, Report&) const override {
    Trajectory out = problem.keyframes;
    out[1].world_from_body.translation.x() += step * ++runs;
    return out;
  }
  double step;
  mutable int runs = 0;
};

class Nondeterminism : public TinyStore {
 protected:
  std::vector<std::string> notes(double step, const std::string& settings) {
    known_.methods.push_back({"unsteady", Kind::corrector, "", {}, [=](const Params&) {
                                return Stage(std::make_unique<const Unsteady>(step));
                              }});
    run("datasets: [line]\nmethods: [unsteady]\nmetrics: [ate]\n" + settings);
    return read_cells(file_).at(0).notes;
  }
};

TEST_F(Nondeterminism, OfTimedRunsIsNoted) {
  EXPECT_THAT(notes(1e-13, "timing: 3\n"),
              testing::Contains("nondeterministic: 3 runs on the same input gave 3 "
                                "different trajectories"));
}

TEST_F(Nondeterminism, IsNotNotedForEqualRuns) {
  EXPECT_THAT(notes(0.0, "timing: 3\n"),
              testing::Not(testing::Contains(testing::HasSubstr("nondeterministic"))));
}

}  // namespace
}  // namespace loopbench::nondeterminism_test
