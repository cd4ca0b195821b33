#include "metrics/doctor/information_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace loopbench::metrics {
namespace {

constexpr double kInformationTooLarge = 100.0,
                 kInformationTooSmall = 1e-5;  // squared errors over stated variances

/// Smaller ones are those of noise-free measurements, which show nothing about the noise.
constexpr double kOfExactMeasurements = 1e-10;

SquaredError median_after_exchange(const std::vector<Edge>& closures, const Chain& chain) {
  const Chain other = exchanged(chain);
  std::vector<SquaredError> all;
  for (const Edge& closure : closures) all.push_back(closure_error(closure, other, true));
  return median_error(all);
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

enum class Kind { odometry, closures, all };

InputFinding wrong_scale(const SquaredError& error,
                         const std::string& measured_on,
                         Kind kind,
                         std::size_t count) {
  const double factor = 1.0 / std::max(error.whole, 1e-30);
  const bool is_all = kind == Kind::all;
  return {
      Fault::information_scale,
      fmt::format("squared gaps of {} are {} times the stated variances (median of {})",
                  measured_on,
                  text(error),
                  count),
      fmt::format("check the information of {}, which would fit after multiplication by {:.1g}; "
                  "for a trajectory: options {}",
                  is_all                   ? "all edges"
                  : kind == Kind::odometry ? "the odometry"
                                           : "the closures",
                  factor,
                  is_all                   ? "odometry.sigma_*, closures.sigma_*"
                  : kind == Kind::odometry ? "odometry.sigma_*"
                                           : "closures.sigma_*"),
      0.8,
      error.translation};
}

}  // namespace

std::vector<InputFinding> check_information(const std::vector<Edge>& closures,
                                            const std::vector<SquaredError>& errors,
                                            const std::vector<SquaredError>& neighbours,
                                            const Chain& chain) {
  constexpr std::size_t kFewest = 2;
  constexpr double kFar = 1000.0, kNear = 100.0;  // in variance
  if (closures.size() < kFewest) return {};
  const SquaredError loops = median_error(errors);
  const double before = distance(loops);
  const SquaredError other =
      before > std::log(kFar) ? median_after_exchange(closures, chain) : loops;
  const double after = distance(other);
  if (before > std::log(kFar) && after < std::min(0.5 * before, std::log(kNear))) {
    return {{Fault::information_order,
             fmt::format("squared gaps of the loops are {} times the stated variances; {} after "
                         "exchange of the blocks",
                         text(loops),
                         text(other)),
             "check the order of the blocks: g2o has those of x y z first",
             1.0 - after / before,
             before}};
  }
  const bool has_neighbours = !neighbours.empty();
  const SquaredError near = median_error(neighbours);
  if (std::min(loops.translation, loops.rotation) > kInformationTooLarge ||
      loops.whole > kInformationTooLarge) {
    const bool is_of_odometry = has_neighbours && near.whole < kInformationTooLarge;
    return {wrong_scale(
        loops, "the loops", is_of_odometry ? Kind::odometry : Kind::all, closures.size())};
  }
  if (loops.whole > kOfExactMeasurements &&
      std::max(loops.translation, loops.rotation) < kInformationTooSmall) {
    return {wrong_scale(loops, "the loops", Kind::all, closures.size())};
  }
  if (has_neighbours && near.whole > kOfExactMeasurements &&
      (near.whole < kInformationTooSmall || near.whole > kInformationTooLarge)) {
    return {wrong_scale(near, "neighbouring closures", Kind::closures, neighbours.size())};
  }
  return {};
}

}  // namespace loopbench::metrics
