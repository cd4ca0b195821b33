// Evaluation and correction inside another program. Exits with 1 if a number is wrong.
#include <cmath>
#include <cstdio>
#include <loopbench/methods/method.hpp>
#include <loopbench/metrics/errors/ate.hpp>
#include <loopbench/metrics/protocols/protocols.hpp>

namespace {

using namespace loopbench;

/// The example of methods/bring_a_method.md: RMSE of the absolute trajectory error [m].
double ate_of(const Trajectory& reference, const Trajectory& estimate) {
  const metrics::Protocol protocol = metrics::named_protocol("loopbench").rules;
  const metrics::Evaluation evaluation = metrics::evaluate(reference, estimate, protocol);
  return metrics::ate(evaluation, {}).front().statistics.rmse;
}

/// Along x with a step of 1 m; the odometry measures 1.1 m, and a closure measures the truth.
Problem line(std::size_t keyframes) {
  Problem out;
  for (std::size_t i = 0; i < keyframes; ++i) {
    const double x = 1.1 * static_cast<double>(i);
    out.keyframes.push_back({static_cast<double>(i), {Rotation::Identity(), {x, 0.0, 0.0}}});
    const Pose step{Rotation::Identity(), {1.1, 0.0, 0.0}};
    if (i > 0) out.odometry.push_back({i - 1, i, step, Matrix6::Identity()});
  }
  const Pose whole{Rotation::Identity(), {static_cast<double>(keyframes - 1), 0.0, 0.0}};
  out.closures.push_back({0, keyframes - 1, whole, 1e8 * Matrix6::Identity()});
  return out;
}

Trajectory corrected(const Problem& problem, const char* name) {
  for (const methods::MethodEntry& entry : methods::methods()) {
    if (entry.name != name) continue;
    methods::Report report;
    const methods::Stage stage = entry.make({});
    return std::get<std::unique_ptr<const methods::Corrector>>(stage)->correct(problem, report);
  }
  return {};
}

}  // namespace

int main() {
  const Problem problem = line(11);
  Trajectory truth = problem.keyframes;
  for (StampedPose& pose : truth) {
    pose.world_from_body.translation = {pose.stamp, std::sin(pose.stamp), 0.0};
  }
  Trajectory moved = truth;
  for (StampedPose& pose : moved) pose.world_from_body.translation.z() += 3.0;
  const double aligned = ate_of(truth, moved);
  const Pose end = corrected(problem, "dual").back().world_from_body;
  std::printf("ATE %.3g m, corrected end at %.6f m\n", aligned, end.translation.x());
  return aligned < 1e-9 && std::abs(end.translation.x() - 10.0) < 1e-3 ? 0 : 1;
}
