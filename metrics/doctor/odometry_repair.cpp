#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

#include "metrics/doctor/closure_repairs.hpp"
#include "metrics/doctor/common_motion.hpp"

namespace loopbench::metrics {
namespace {

/// Median difference of the odometry and the keyframes, over the keyframes' median step [-].
double odometry_error(const Problem& problem, const std::function<Pose(const Pose&)>& change) {
  std::vector<double> errors, steps;
  for (const Edge& edge : problem.odometry) {
    const Pose step = problem.keyframes[edge.from].world_from_body.inverse() *
                      problem.keyframes[edge.to].world_from_body;
    errors.push_back((change(edge.from_from_to).translation - step.translation).norm());
    steps.push_back(step.translation.norm());
  }
  const double step = median_value(std::move(steps));
  return step > 0.0 ? median_value(std::move(errors)) / step : 0.0;
}

}  // namespace

std::optional<InputFinding> find_odometry_repair(const Problem& problem) {
  constexpr double kBad = 0.3, kBetter = 0.2;
  const double before = odometry_error(problem, [](const Pose& p) { return p; });
  if (before < kBad) return std::nullopt;
  const auto prove =
      [&](Fault fault,
          const std::string& what,
          const char* fix,
          const std::function<Pose(const Pose&)>& change) -> std::optional<InputFinding> {
    const double after = odometry_error(problem, change);
    if (after > kBetter * before) return std::nullopt;
    return InputFinding{fault,
                        fmt::format("{}: difference to the vertices {:.3g} -> {:.3g} % of a step",
                                    what,
                                    100.0 * before,
                                    100.0 * after),
                        fix,
                        1.0 - after / before,
                        static_cast<double>(problem.odometry.size())};
  };
  if (auto found = prove(Fault::odometry_direction,
                         "inverting the odometry",
                         "exchange the two vertices of each odometry edge",
                         [](const Pose& p) { return p.inverse(); })) {
    return found;
  }
  for (const double factor : {0.001, 0.01, 100.0, 1000.0}) {
    auto found = prove(Fault::closure_unit,
                       fmt::format("multiplying the odometry's translations by {:g}", factor),
                       "write all edges and vertices in metres",
                       [=](const Pose& p) -> Pose {
                         return {p.rotation, factor * p.translation};
                       });
    if (found) return found;
  }
  return std::nullopt;
}

}  // namespace loopbench::metrics
