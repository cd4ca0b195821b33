#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/map_checks.hpp"
#include "metrics/doctor/map_pairs.hpp"

namespace loopbench::metrics {

using namespace map_pairs;

std::optional<InputFinding> remove_frozen(Paired& pairs,
                                          const Trajectory& file,
                                          bool of_reference) {
  constexpr double kLeast = 2.0, kOfSpread = 0.05;  // [s]
  const Trajectory& own = of_reference ? pairs.reference : pairs.estimate;
  const Trajectory& other = of_reference ? pairs.estimate : pairs.reference;
  const std::size_t n = own.size();
  if (n < kFewestCommonPoses) return std::nullopt;
  const double least = std::max(kLeast, kUsualGaps * usual_interval(own));
  const double moves = kOfSpread * spread(other);
  Paired kept;
  RowRange longest;
  double all = 0.0;
  for (std::size_t i = 0; i < n;) {
    std::size_t end = i + 1;
    while (end < n && are_equal(pose_in(own, end), pose_in(own, i))) ++end;
    const double seconds = own[end - 1].stamp - own[i].stamp;
    const bool is_frozen = seconds >= least && displacement(other, i, end - 1) > moves;
    if (is_frozen) {
      all += seconds;
      if (seconds > own[longest.end == 0 ? 0 : longest.end - 1].stamp - own[longest.begin].stamp)
        longest = {i, end};
    }
    for (std::size_t k = i; k < (is_frozen ? i + 1 : end); ++k) {
      kept.reference.push_back(pairs.reference[k]);
      kept.estimate.push_back(pairs.estimate[k]);
    }
    i = end;
  }
  if (longest.end == 0) return std::nullopt;
  const double first = own[longest.begin].stamp, last = own[longest.end - 1].stamp;
  std::string what = fmt::format(
      "the {}'s pose is the same from {} to {:.3f}, for {:.1f} s, while the other file moves by "
      "{:.3g} m",
      of_reference ? "reference" : "estimate",
      place(file, std::min(row_at(file, first), file.size() - 1)),
      last,
      last - first,
      displacement(other, longest.begin, longest.end - 1));
  if (all > 1.01 * (last - first)) what += fmt::format("; all in all for {:.1f} s", all);
  pairs = std::move(kept);
  return InputFinding{Fault::frozen,
                      what,
                      "evaluate the parts around it (eval --parts auto), or remove these rows",
                      1.0,
                      last - first};
}

namespace {

/// Rows around the pairs of `all` that are not in `kept`, up to the pairs that are. O(pairs).
std::vector<RowRange> left_out(const Trajectory& all,
                               const Trajectory& kept,
                               const Trajectory& file) {
  std::vector<RowRange> out;
  bool is_kept = true;
  std::size_t next = 0;  // of `kept`
  for (const StampedPose& pose : all) {
    const bool was_kept = is_kept;
    is_kept = next < kept.size() && kept[next].stamp == pose.stamp;
    const std::size_t row = row_at(file, pose.stamp);
    if (!is_kept && was_kept) out.push_back({next == 0 ? 0 : row, file.size()});
    if (is_kept && !was_kept) out.back().end = row;
    if (is_kept) ++next;
  }
  return out;
}

}  // namespace

std::vector<RowRange> map_parts(const Trajectory& reference,
                                const Trajectory& estimate,
                                double offset) {
  PartedPairs parted{common_poses(reference, estimate, offset, estimate.size()), {}};
  const std::size_t n = estimate.size();
  if (parted.pairs.estimate.size() < kFewestCommonPoses) return {{0, n}};
  const Trajectory all = parted.pairs.estimate;
  remove_frozen(parted.pairs, estimate, false);
  std::vector<RowRange> between;
  if (join_maps(parted, estimate, kMostRatio) || join_scales(parted, estimate)) {
    for (std::size_t k = 1; k < parted.parts.size(); ++k) {
      const std::size_t row = row_at(estimate, parted.pairs.estimate[parted.parts[k].begin].stamp);
      between.push_back({row, row});
    }
  }
  std::ranges::copy(left_out(all, parted.pairs.estimate, estimate), std::back_inserter(between));
  std::ranges::sort(between, {}, &RowRange::begin);
  between.push_back({n, n});
  std::vector<RowRange> out;
  std::size_t begin = 0;
  for (const RowRange& rows : between) {
    if (rows.begin > begin) out.push_back({begin, rows.begin});
    begin = std::max(begin, rows.end);
  }
  return out;
}

}  // namespace loopbench::metrics
