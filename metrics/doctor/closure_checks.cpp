#include "metrics/doctor/closure_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "metrics/doctor/closure_chain.hpp"
#include "metrics/doctor/closure_gaps.hpp"
#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/edge_checks.hpp"
#include "metrics/doctor/information_checks.hpp"
#include "metrics/doctor/loop_likelihood.hpp"

namespace loopbench::metrics {
namespace {

InputFinding inverted_closures(std::string evidence, double confidence, std::size_t inverted) {
  return {Fault::closure_direction,
          std::move(evidence),
          "exchange the two vertices of each closure; in a file of loops the first two columns",
          confidence,
          static_cast<double>(inverted)};
}

/// For closures without neighbours: an inversion shows where the drift is small against it.
std::vector<InputFinding> check_direction_of_few(const Problem& problem, const Chain& chain) {
  constexpr double kLikelier = 5.0;
  constexpr std::size_t kMostClosures = 12;  // that are compared
  const std::size_t step = (problem.closures.size() - 1) / kMostClosures + 1;
  std::vector<Edge> closures;
  for (std::size_t i = 0; i < problem.closures.size(); i += step) {
    closures.push_back(problem.closures[i]);
  }
  const double likelier = inversion_log_ratio(closures, chain);
  if (!(likelier > kLikelier)) return {};
  return {inverted_closures(
      fmt::format("{} closures fit the odometry better after inversion (logarithm of the ratio of "
                  "likelihoods {:.1f})",
                  closures.size(),
                  likelier),
      1.0 - std::exp(-0.25 * likelier),
      problem.closures.size())};
}

std::vector<InputFinding> check_direction(const Problem& problem,
                                          const std::vector<Neighbours>& neighbours,
                                          const Chain& chain) {
  constexpr double kBetter = 0.5;
  constexpr std::size_t kFewest = 3;
  if (neighbours.size() < kFewest) return check_direction_of_few(problem, chain);
  const auto median_of = [&](bool inverted, bool of_rotation) {
    std::vector<double> norms;
    for (const Neighbours& pair : neighbours) {
      const Twist residual = neighbour_residual(pair, chain, inverted);
      norms.push_back(of_rotation ? residual.tail<3>().norm() : residual.head<3>().norm());
    }
    return median_value(std::move(norms));
  };
  const double translation = median_of(false, false);
  const double translation_inverted = median_of(true, false);
  const double rotation = median_of(false, true);
  const double rotation_inverted = median_of(true, true);
  const bool is_inverted =
      translation_inverted < kBetter * translation && rotation_inverted < 1.2 * rotation + 1e-9;
  if (!is_inverted) return {};
  return {inverted_closures(
      fmt::format("neighbouring closures differ by {:.3g} m (median of {} pairs), after "
                  "inversion by {:.3g} m",
                  translation,
                  neighbours.size(),
                  translation_inverted),
      1.0 - translation_inverted / translation,
      problem.closures.size())};
}

}  // namespace

std::vector<InputFinding> check_closures(const Problem& problem) {
  std::vector<InputFinding> out;
  const bool is_chain = problem.odometry.size() + 1 == problem.keyframes.size();
  if (problem.closures.empty() || !is_chain) return out;
  const Chain chain = chain_of(problem);
  const std::vector<Neighbours> neighbours = neighbours_of(problem.closures, chain);
  out = check_direction(problem, neighbours, chain);
  if (!out.empty()) return out;
  std::vector<SquaredError> errors;
  for (const Edge& edge : problem.closures) errors.push_back(closure_error(edge, chain, false));
  const std::vector<SquaredError> of_pairs = neighbour_errors(neighbours, chain);
  for (const auto& found : {check_gaps(problem, chain, errors),
                            check_information(problem.closures, errors, of_pairs, chain),
                            check_edges(problem.closures, neighbours, of_pairs)}) {
    out.insert(out.end(), found.begin(), found.end());
  }
  return out;
}

}  // namespace loopbench::metrics
