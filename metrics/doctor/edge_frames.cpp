#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "metrics/doctor/graph_checks.hpp"
#include "metrics/doctor/sampling.hpp"

namespace loopbench::metrics {
namespace {

/// What the translation of an edge can mean.
enum class Meaning { as_stated, of_other_end, in_world };

/// Distance of an edge's translation from that between its vertices, in the axes that it means [m].
double misfit(const Problem& problem, const Edge& edge, Meaning meaning) {
  const Pose& from = problem.keyframes[edge.from].world_from_body;
  const Pose& to = problem.keyframes[edge.to].world_from_body;
  const Vector3& measured = edge.from_from_to.translation;
  const Vector3 between = to.translation - from.translation;
  switch (meaning) {
    case Meaning::as_stated:
      return (measured - from.rotation.inverse() * between).norm();
    case Meaning::of_other_end:
      return (measured + to.rotation.inverse() * between).norm();
    case Meaning::in_world:
      return (measured - between).norm();
  }
  return 0.0;
}

struct Fit {
  double before = 0.0, after = 0.0;  ///< median distances [m]
  bool is_better = false;
};

/// Better: a quarter of the median distance, and smaller for nearly all edges. One of the two alone
/// can be due to drift of the vertices, or to a road along an axis of the world.
Fit fit_of(const Problem& problem, const std::vector<Edge>& edges, Meaning meaning) {
  constexpr std::size_t kFewest = 6;
  constexpr double kMostPart = 0.25, kNearlyAll = 0.8;
  if (edges.size() < kFewest) return {};
  std::vector<double> before, after;
  double better = 0.0;
  const std::size_t step = even_step(edges.size(), kMostPoses);
  for (std::size_t k = 0; k < edges.size(); k += step) {
    before.push_back(misfit(problem, edges[k], Meaning::as_stated));
    after.push_back(misfit(problem, edges[k], meaning));
    better += after.back() < before.back() ? 1.0 : 0.0;
  }
  const auto count = static_cast<double>(before.size());
  Fit out{median_value(std::move(before)), median_value(std::move(after))};
  out.is_better = out.before > kFileRounding && out.after < kMostPart * out.before &&
                  better >= kNearlyAll * count;
  return out;
}

}  // namespace

std::optional<InputFinding> check_edge_frames(const Problem& problem) {
  const auto finding = [&](Fault::Name fault,
                           const std::vector<Edge>& edges,
                           const std::string& evidence,
                           const std::string& fix,
                           const Fit& fit) {
    return InputFinding{
        fault,
        fmt::format("{}: their median distance from the motion between the vertices is {:.3g} m "
                    "as stated, and {:.3g} m then",
                    evidence,
                    fit.before,
                    fit.after),
        fix,
        1.0 - fit.after / fit.before,
        static_cast<double>(edges.size())};
  };
  const std::vector<Edge>&steps = problem.odometry, &closures = problem.closures;
  if (const Fit fit = fit_of(problem, steps, Meaning::of_other_end); fit.is_better) {
    return finding(Fault::closure_direction,
                   steps,
                   "the edges of the odometry fit the vertices in the other direction",
                   "exchange the two vertices of each edge",
                   fit);
  }
  for (const bool of_steps : {true, false}) {
    const std::vector<Edge>& edges = of_steps ? steps : closures;
    const Fit fit = fit_of(problem, edges, Meaning::in_world);
    if (!fit.is_better) continue;
    return finding(Fault::closure_convention,
                   edges,
                   std::string(of_steps ? "the edges of the odometry" : "the closures") +
                       " have their translations in the axes of the world",
                   "write the translation of each edge in the axes of its first pose",
                   fit);
  }
  return std::nullopt;
}

}  // namespace loopbench::metrics
