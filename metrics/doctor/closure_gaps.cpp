#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/graph_checks.hpp"

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
                                             const Chain& chain) {
  std::vector<double> drifts, errors;
  for (const Edge& edge : closures) {
    drifts.push_back(drift_of(edge, chain));
    errors.push_back(closure_error(edge, chain, false).whole);
  }
  const double drift = most_drift(drifts), error = most_error(errors);
  std::vector<GapOverLimit> out;
  for (std::size_t i = 0; i < closures.size(); ++i) {
    const double distance = gap_of(closures[i], chain);
    const double length = chain.length(closures[i].from, closures[i].to);
    const double over = std::max(distance / (kLeastFalseGap + drift * length), errors[i] / error);
    out.push_back({&closures[i], distance, length, distance > kLeastFalseGap ? over : 0.0});
  }
  return out;
}

/// Along the odometry, or over that other closure from which the sections of odometry are shortest:
/// drift is smaller along these. `closures` are sorted by their ends; of these, the nearest are
/// compared.
GapOverLimit gap_over_shortest_path(const std::vector<const Edge*>& closures,
                                    std::size_t index,
                                    const Chain& chain) {
  constexpr double kClosureLength = 2.0;  // [m]
  constexpr std::size_t kCompared = 20;   // before and after
  const Edge& edge = *closures[index];
  GapOverLimit out{&edge, gap_of(edge, chain), chain.length(edge.from, edge.to)};
  const std::size_t end = std::min(closures.size(), index + kCompared + 1);
  for (std::size_t j = index - std::min(index, kCompared); j < end; ++j) {
    const Neighbours pair{&edge, closures[j]};
    const double length =
        kClosureLength + chain.length(edge.from, pair.b->from) + chain.length(edge.to, pair.b->to);
    if (j == index || length >= out.length) continue;
    out.length = length;
    out.distance = neighbour_residual(pair, chain).head<3>().norm();
  }
  return out;
}

std::vector<GapOverLimit> gaps_over_paths(const std::vector<const Edge*>& closures,
                                          const Chain& chain) {
  std::vector<double> drifts;
  std::vector<GapOverLimit> out;
  for (std::size_t i = 0; i < closures.size(); ++i) {
    out.push_back(gap_over_shortest_path(closures, i, chain));
    drifts.push_back(out.back().distance / std::max(1.0, out.back().length));
  }
  const double drift = most_drift(drifts);
  for (GapOverLimit& gap : out) gap.over = gap.distance / (kLeastFalseGap + drift * gap.length);
  return out;
}

/// The closures over their limit. `others` are those that were found before. Empty if the gaps of
/// the other closures are not smaller: removing what was found would not help then.
GapCheck implausible(const std::vector<GapOverLimit>& gaps,
                     const Edge* first_closure,
                     const std::string& contradicted_by,
                     const std::vector<GapOverLimit>& others = {}) {
  GapCheck out;
  std::vector<GapOverLimit> found = others;
  double squares = 0.0, squares_of_found = 0.0;  // of gaps [m^2]
  for (const GapOverLimit& gap : others) squares_of_found += gap.distance * gap.distance;
  for (const GapOverLimit& gap : gaps) {
    (gap.over > 1.0 ? squares_of_found : squares) += gap.distance * gap.distance;
    if (gap.over > 1.0) found.push_back(gap);
  }
  const auto rms = [](double sum, std::size_t count) {
    return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, count)));
  };
  const std::size_t count = gaps.size() + others.size();
  const double before = rms(squares + squares_of_found, count);
  const double after = rms(squares, count - found.size());
  if (found.empty() || after >= before) return out;
  const GapOverLimit& worst = *std::ranges::max_element(found, {}, &GapOverLimit::over);
  for (const GapOverLimit& gap : found) {
    out.closures.push_back(static_cast<std::size_t>(gap.closure - first_closure));
  }
  out.finding = InputFinding{
      Fault::closure_gap,
      fmt::format("{} of {} closures contradict {}, most of all {} -> {}: the gap is {:.3g} m "
                  "after {:.3g} m; without them, rms of the gaps {:.3g} -> {:.3g} m",
                  found.size(),
                  count,
                  contradicted_by,
                  worst.closure->from,
                  worst.closure->to,
                  worst.distance,
                  worst.length,
                  before,
                  after),
      "check them; robust methods are made for false closures",
      std::max(1.0 - after / before, 1.0 - 1.0 / worst.over),
      static_cast<double>(found.size())};
  return out;
}

/// A false closure on the shortest path of others makes these contradict it: the worst one is
/// removed until nothing contradicts.
GapCheck implausible_paths(const std::vector<Edge>& closures, const Chain& chain) {
  constexpr std::size_t kMostRemoved = 12;
  std::vector<GapOverLimit> removed;
  std::vector<const Edge*> left;
  for (const Edge& edge : closures) left.push_back(&edge);
  std::ranges::stable_sort(left, {}, [](const Edge* e) { return std::max(e->from, e->to); });
  for (;;) {
    const std::vector<GapOverLimit> gaps = gaps_over_paths(left, chain);
    if (gaps.empty()) return {};
    const GapOverLimit& worst = *std::ranges::max_element(gaps, {}, &GapOverLimit::over);
    if (!(worst.over > 1.0) || removed.size() == kMostRemoved) {
      return implausible(gaps, closures.data(), "other closures and the odometry", removed);
    }
    removed.push_back(worst);
    std::erase(left, worst.closure);
  }
}

}  // namespace

GapCheck check_gaps(const std::vector<Edge>& closures, const Chain& chain) {
  constexpr std::size_t kFewestForPaths = 10;
  GapCheck found =
      implausible(gaps_over_odometry(closures, chain), closures.data(), "the odometry");
  if (found.finding || closures.size() < kFewestForPaths) return found;
  return implausible_paths(closures, chain);
}

}  // namespace loopbench::metrics
