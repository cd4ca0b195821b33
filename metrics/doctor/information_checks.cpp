#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/graph_checks.hpp"

namespace loopbench::metrics {
namespace {

constexpr double kInformationTooLarge = 100.0,
                 kInformationTooSmall = 1e-5;  // squared errors over stated variances

/// Smaller ones are those of noise-free measurements, which show nothing about the noise.
constexpr double kOfExactMeasurements = 1e-10;

std::vector<SquaredError> loop_errors(const std::vector<Edge>& closures,
                                      const Chain& chain,
                                      bool is_exchanged = false) {
  std::vector<SquaredError> out;
  for (const Edge& closure : closures) {
    out.push_back(closure_error(closure, chain, is_exchanged));
  }
  return out;
}

/// How far translation and rotation are from what is stated, in logarithms.
double distance(const SquaredError& error) {
  const auto logarithm = [](double x) { return std::abs(std::log(std::max(x, 1e-12))); };
  return logarithm(error.translation) + logarithm(error.rotation);
}

std::string text(const SquaredError& error) {
  return fmt::format(
      "{:.3g} (translation) and {:.3g} (rotation)", error.translation, error.rotation);
}

/// Edges whose information is wrong, and the gaps that show it.
struct WrongScale {
  const char* edges;
  const char* options;
  bool is_of_odometry = true, is_of_closures = true;
  bool is_of_neighbours = false;  ///< shown by neighbouring closures instead of loops
};

/// The factor is estimated from every other gap, and tested on the remaining ones.
std::optional<InputFinding> wrong_scale(const WrongScale& wrong,
                                        const std::vector<Edge>& closures,
                                        const Chain& chain) {
  constexpr int kMostSteps = 8;
  constexpr double kNearOne = 1.3;
  std::size_t count = 0;
  const auto median_after = [&](double factor, std::size_t first) {
    std::vector<Edge> edges = closures;
    Chain scaled = chain;
    for (Edge& edge : edges) edge.information *= wrong.is_of_closures ? factor : 1.0;
    for (Matrix6& each : scaled.covariances) each /= wrong.is_of_odometry ? factor : 1.0;
    const std::vector<SquaredError> all =
        wrong.is_of_neighbours ? neighbour_errors(neighbours_of(edges, scaled), scaled)
                               : loop_errors(edges, scaled);
    count = all.size();
    constexpr std::size_t kFewestForHalves = 6;
    const bool has_halves = all.size() >= kFewestForHalves;
    std::vector<double> part;
    for (std::size_t i = has_halves ? first : 0; i < all.size(); i += has_halves ? 2 : 1) {
      part.push_back(all[i].whole);
    }
    return std::max(median_value(std::move(part)), 1e-30);
  };
  double factor = 1.0;
  for (int step = 0; step < kMostSteps; ++step) {  // the other edges have a part in each error
    const double error = median_after(factor, 0);
    if (std::abs(std::log(error)) < std::log(kNearOne)) break;
    factor /= error;
  }
  const double before = median_after(1.0, 1), after = median_after(factor, 1);
  if (std::abs(std::log(after)) > std::abs(std::log(before))) return std::nullopt;
  return InputFinding{
      Fault::information_scale,
      fmt::format("squared gaps of {} over their stated variances (median of {}): {:.3g} -> {:.3g} "
                  "with the information of {} times {:.1g}",
                  wrong.is_of_neighbours ? "neighbouring closures" : "the loops",
                  count,
                  before,
                  after,
                  wrong.edges,
                  factor),
      fmt::format(
          "check the information of {}; for a trajectory: options {}", wrong.edges, wrong.options),
      0.8,
      before};
}

}  // namespace

std::optional<InputFinding> check_information(const std::vector<Edge>& closures,
                                              const Chain& chain) {
  constexpr std::size_t kFewest = 2;
  constexpr double kFar = 1000.0, kNear = 100.0;  // in variance
  if (closures.size() < kFewest) return std::nullopt;
  const SquaredError loops = median_error(loop_errors(closures, chain));
  const double before = distance(loops);
  const SquaredError other =
      before > std::log(kFar) ? median_error(loop_errors(closures, exchanged(chain), true)) : loops;
  const double after = distance(other);
  if (before > std::log(kFar) && after < std::min(0.5 * before, std::log(kNear))) {
    return InputFinding{
        Fault::information_order,
        fmt::format("squared gaps of the loops are {} times the stated variances; {} after "
                    "exchange of the blocks",
                    text(loops),
                    text(other)),
        "check the order of the blocks: g2o has those of x y z first",
        1.0 - after / before,
        before};
  }
  const std::vector<SquaredError> neighbours =
      neighbour_errors(neighbours_of(closures, chain), chain);
  const bool has_neighbours = !neighbours.empty();
  const SquaredError near = median_error(neighbours);
  const WrongScale of_all{"all edges", "odometry.sigma_*, closures.sigma_*"};
  if (std::min(loops.translation, loops.rotation) > kInformationTooLarge ||
      loops.whole > kInformationTooLarge) {
    const bool is_of_odometry = has_neighbours && near.whole < kInformationTooLarge;
    return wrong_scale(
        is_of_odometry ? WrongScale{"the odometry", "odometry.sigma_*", true, false} : of_all,
        closures,
        chain);
  }
  if (loops.whole > kOfExactMeasurements &&
      std::max(loops.translation, loops.rotation) < kInformationTooSmall) {
    return wrong_scale(of_all, closures, chain);
  }
  if (has_neighbours && near.whole > kOfExactMeasurements &&
      (near.whole < kInformationTooSmall || near.whole > kInformationTooLarge)) {
    return wrong_scale({"the closures", "closures.sigma_*", false, true, true}, closures, chain);
  }
  return std::nullopt;
}

}  // namespace loopbench::metrics
