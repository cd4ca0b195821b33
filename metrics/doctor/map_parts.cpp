#include <fmt/format.h>

#include <algorithm>
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

std::vector<RowRange> map_parts(const Trajectory& reference,
                                const Trajectory& estimate,
                                double offset) {
  PartedPairs parted{common_poses(reference, estimate, offset, estimate.size()), {}};
  const std::size_t n = estimate.size();
  Paired& pairs = parted.pairs;
  if (pairs.estimate.size() < kFewestCommonPoses) return {{0, n}};
  std::vector<RowRange> out;
  const Paired all = pairs;
  remove_frozen(pairs, estimate, false);
  std::vector<std::size_t> borders;  // rows at which a part begins
  if (join_maps(parted, estimate, kMostRatio) || join_scales(parted, estimate)) {
    for (std::size_t k = 1; k < parted.parts.size(); ++k) {
      const double stamp = parted.pairs.estimate[parted.parts[k].begin].stamp;
      borders.push_back(row_at(estimate, stamp));
    }
  }
  // Frozen rows are those that are gone before the maps were joined.
  Paired thawed = all;
  const bool has_frozen = remove_frozen(thawed, estimate, false).has_value();
  std::vector<RowRange> frozen;
  for (std::size_t i = 0, j = 0; has_frozen && i < all.estimate.size(); ++i) {
    const double stamp = all.estimate[i].stamp;
    if (j < thawed.estimate.size() && thawed.estimate[j].stamp == stamp) {
      ++j;
      continue;
    }
    const std::size_t row = row_at(estimate, stamp);
    if (frozen.empty() || frozen.back().end != row) frozen.push_back({row, row});
    frozen.back().end = row + 1;
  }
  RowRange part{0, n};
  std::size_t next_frozen = 0, next_border = 0;
  const auto close = [&](std::size_t end, std::size_t begin) {
    if (end > part.begin) out.push_back({part.begin, end});
    part.begin = begin;
  };
  while (next_frozen < frozen.size() || next_border < borders.size()) {
    const bool is_frozen =
        next_border == borders.size() ||
        (next_frozen < frozen.size() && frozen[next_frozen].begin <= borders[next_border]);
    if (is_frozen) {
      close(frozen[next_frozen].begin, frozen[next_frozen].end);
      ++next_frozen;
    } else {
      close(std::max(part.begin, borders[next_border]), std::max(part.begin, borders[next_border]));
      ++next_border;
    }
  }
  close(n, n);
  return out;
}

}  // namespace loopbench::metrics
