#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/doctor/graph_checks.hpp"
#include "metrics/doctor/sampling.hpp"

namespace loopbench::metrics {
namespace {

/// Part of the stamps that are those of poses after multiplication by a factor.
double found_part(const std::vector<double>& loops, const Trajectory& poses, double factor) {
  const auto count = std::ranges::count_if(loops, [&](double stamp) {
    const double first = factor * stamp - kLeastOffset;
    const auto next = std::ranges::lower_bound(poses, first, {}, &StampedPose::stamp);
    return next != poses.end() && next->stamp <= first + 2.0 * kLeastOffset;
  });
  return static_cast<double>(count) / static_cast<double>(loops.size());
}

}  // namespace

std::optional<InputFinding> check_loop_stamps(const std::vector<double>& loops,
                                              const Trajectory& poses) {
  constexpr double kMost = 0.5, kLeastSpan = 0.05;
  if (loops.empty() || poses.empty()) return std::nullopt;
  const double as_read = found_part(loops, poses, 1.0);
  if (as_read > kMost) return std::nullopt;
  const auto [first, last] = std::ranges::minmax(loops);
  const double begin = poses.front().stamp, end = poses.back().stamp;
  InputFinding out{Fault::loop_stamps,
                   fmt::format("{:.0f} % of the loops' stamps ({:.15g} to {:.15g}) are those of "
                               "poses ({:.3f} to {:.3f})",
                               100.0 * as_read,
                               first,
                               last,
                               begin,
                               end),
                   "give the loops of this trajectory, with its stamps",
                   1.0 - as_read,
                   begin - first};
  for (const double factor : {1e-3, 1e-6, 1e-9}) {
    const double part = found_part(loops, poses, factor);
    if (part <= kMost || factor * (last - first) < kLeastSpan * (end - begin)) continue;
    out.evidence += fmt::format("; times {:g}, {:.0f} %", factor, 100.0 * part);
    out.fix = "write the stamps of the loops in seconds";
    out.value = 1.0 / factor;
    return out;
  }
  const auto is_whole = [](double stamp) { return stamp == std::round(stamp); };
  if (first >= 0.0 && last <= static_cast<double>(poses.size()) && last < begin &&
      std::ranges::all_of(loops, is_whole)) {
    out.evidence += ": they are numbers of poses or frames";
    out.fix = "write the stamps of the poses";
    out.value = last;
  }
  return out;
}

}  // namespace loopbench::metrics
