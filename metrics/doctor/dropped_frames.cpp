#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "metrics/doctor/pair_checks.hpp"
#include "metrics/doctor/speed_match.hpp"

namespace loopbench::metrics {

std::optional<InputFinding> check_dropped_frames(const Trajectory& reference,
                                                 const Trajectory& estimate) {
  constexpr double kOtherRate = 0.07;  // logarithm; the parts below see smaller ones
  constexpr double kCells = 120.0;     // of the reference, whose speeds are compared
  constexpr int kSearched = 6;         // per cent of the rate, and cells
  constexpr double kOfCell = 0.5;      // steps of the offsets of parts
  constexpr std::size_t kParts = 5, kFewest = 4;
  const auto finding = [&](Fault::Name fault, const std::string& evidence, double value) {
    return InputFinding{
        fault, evidence, "write the stamp of each frame in seconds", kSameCorrelation, value};
  };
  const bool has_indices = has_frame_indices(estimate) && !has_frame_indices(reference);
  const double cell = duration(reference) / kCells,
               ratio = duration(reference) / duration(estimate);
  double factor = 1.0;
  BestOffset best;
  for (int k = -kSearched; k <= kSearched; ++k) {
    const double each = ratio * (1.0 + 0.01 * k);
    const SpeedMatch match(reference, estimate, kFewIntervals, cell, reference.front().stamp, each);
    const BestOffset found = search_offsets(match, -kSearched * cell, kSearched * cell, cell);
    if (found.score < best.score) continue;
    best = found;
    factor = each;
  }
  if (std::abs(std::log(factor)) > kOtherRate && best.score > kSameCorrelation) {
    return finding(
        has_indices ? Fault::no_overlap : Fault::missing_poses,
        fmt::format("the estimate's stamps {}: times {:.3g}, correlation of speeds {:.2f}",
                    has_indices ? "are frame numbers" : "have another rate, or it lacks poses",
                    factor,
                    best.score),
        factor);
  }
  std::vector<double> offsets;
  for (std::size_t k = 0; k < kParts; ++k) {
    const std::size_t begin = k * estimate.size() / kParts,
                      end = (k + 1) * estimate.size() / kParts;
    const auto part = std::span(estimate).subspan(begin, end - begin);
    const SpeedMatch match(reference,
                           part,
                           kFewIntervals,
                           std::max(least_interval(reference, part), kOfCell * cell),
                           part.front().stamp);
    const double most = kSearched * cell;
    const BestOffset found = search_offsets(match, -most, most, kOfCell * cell);
    if (found.score > kSameCorrelation) offsets.push_back(found.offset);
  }
  if (offsets.size() < kFewest || !std::ranges::is_sorted(offsets)) return std::nullopt;
  return finding(Fault::missing_poses,
                 fmt::format("the estimate's fifths have offsets of {:.3f} s, as if frames had "
                             "been dropped before stamps were written",
                             fmt::join(offsets, ", ")),
                 offsets.back() - offsets.front());
}

}  // namespace loopbench::metrics
