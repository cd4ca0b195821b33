#include "metrics/doctor/closure_gaps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "metrics/doctor/closure_paths.hpp"
#include "metrics/doctor/common_motion.hpp"

namespace loopbench::metrics {
namespace {

constexpr double kLeastFalseGap = 2.0;  // [m]; smaller gaps are no false closures
constexpr double kMostUsualDrift = 0.35, kOverUsualDrift = 8.0;

/// Limit of a gap over the length of its loop: eight times the drift of most loops.
double most_drift(std::vector<double> drifts) {
  constexpr std::size_t kFewest = 4;
  if (drifts.size() < kFewest) return kMostUsualDrift;
  return std::min(kMostUsualDrift, kOverUsualDrift * median_value(std::move(drifts)));
}

/// Limit of the squared error over its variance: fifty times that of nine in ten closures.
double most_error(std::vector<double> errors) {
  constexpr double kOverNineInTen = 50.0;
  constexpr std::size_t kFewest = 4;
  if (errors.size() < kFewest) return std::numeric_limits<double>::infinity();
  const std::size_t nine_in_ten = 9 * (errors.size() - 1) / 10;
  std::ranges::nth_element(errors, errors.begin() + static_cast<std::ptrdiff_t>(nine_in_ten));
  return kOverNineInTen * errors[nine_in_ten];
}

/// A gap in units of its limit; above 1 it is implausible.
struct GapOverLimit {
  const Edge* closure = nullptr;
  double distance = 0.0;  ///< [m]
  double length = 0.0;    ///< of the path without the closure [m]
  double over = 0.0;
};

std::vector<GapOverLimit> gaps_over_odometry(const std::vector<Edge>& closures,
                                             const Chain& chain,
                                             const std::vector<SquaredError>& squares) {
  std::vector<double> drifts, errors;
  for (std::size_t i = 0; i < closures.size(); ++i) {
    drifts.push_back(drift_of(closures[i], chain));
    errors.push_back(squares[i].whole);
  }
  const double drift = most_drift(drifts);
  const double error = most_error(errors);
  std::vector<GapOverLimit> out;
  for (std::size_t i = 0; i < closures.size(); ++i) {
    const Edge& edge = closures[i];
    const double distance = gap_of(edge, chain);
    const double length = chain.length(edge.from, edge.to);
    const double over = std::max(distance / (kLeastFalseGap + drift * length), errors[i] / error);
    out.push_back({&edge, distance, length, distance > kLeastFalseGap ? over : 0.0});
  }
  return out;
}

std::vector<GapOverLimit> gaps_over_paths(const Problem& problem, const Chain& chain) {
  std::vector<double> drifts;
  const std::vector<PathGap> all = path_gaps(problem, chain);
  for (const PathGap& gap : all) drifts.push_back(gap.distance / std::max(1.0, gap.length));
  const double drift = most_drift(drifts);
  std::vector<GapOverLimit> out;
  for (const auto& [closure, distance, length] : all) {
    out.push_back({closure, distance, length, distance / (kLeastFalseGap + drift * length)});
  }
  return out;
}

std::vector<InputFinding> implausible(const std::vector<GapOverLimit>& gaps,
                                      const Edge* first_closure,
                                      const std::string& contradicted_by) {
  std::vector<std::size_t> found;
  double plausible_squares = 0.0, squares = 0.0;  // of the gaps [m^2]
  const GapOverLimit* worst = nullptr;
  for (const GapOverLimit& gap : gaps) {
    const double square = gap.distance * gap.distance;
    squares += square;
    if (!(gap.over > 1.0)) {
      plausible_squares += square;
      continue;
    }
    found.push_back(static_cast<std::size_t>(gap.closure - first_closure));
    if (worst == nullptr || gap.over > worst->over) worst = &gap;
  }
  if (worst == nullptr) return {};
  const std::size_t plausible = std::max<std::size_t>(1, gaps.size() - found.size());
  const double rms_before = std::sqrt(squares / static_cast<double>(gaps.size()));
  const double rms_after = std::sqrt(plausible_squares / static_cast<double>(plausible));
  return {{Fault::closure_gap,
           fmt::format("{} of {} closures contradict {}, most of all {} -> {}: the gap is {:.3g} m "
                       "after {:.3g} m",
                       found.size(),
                       gaps.size(),
                       contradicted_by,
                       worst->closure->from,
                       worst->closure->to,
                       worst->distance,
                       worst->length),
           "check them; robust methods are made for false closures",
           1.0 - rms_after / rms_before,
           static_cast<double>(found.size())}};
}

}  // namespace

std::vector<InputFinding> check_gaps(const Problem& problem,
                                     const Chain& chain,
                                     const std::vector<SquaredError>& errors) {
  constexpr std::size_t kFewestForPaths = 10;
  const Edge* const first = problem.closures.data();
  auto found =
      implausible(gaps_over_odometry(problem.closures, chain, errors), first, "the odometry");
  if (!found.empty() || problem.closures.size() < kFewestForPaths) return found;
  return implausible(gaps_over_paths(problem, chain), first, "other closures and the odometry");
}

}  // namespace loopbench::metrics
