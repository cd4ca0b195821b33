#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/doctor/graph_checks.hpp"

namespace loopbench::metrics {
namespace {

/// Part of the stamps that are those of poses after a change.
double found_part(const std::vector<double>& loops,
                  const Trajectory& poses,
                  double factor,
                  double offset) {
  constexpr double kMaxDiff = 0.02;  // [s]
  const auto count = std::ranges::count_if(loops, [&](double stamp) {
    const double at = factor * stamp + offset;
    const auto next = std::ranges::lower_bound(poses, at - kMaxDiff, {}, &StampedPose::stamp);
    return next != poses.end() && next->stamp <= at + kMaxDiff;
  });
  return static_cast<double>(count) / static_cast<double>(loops.size());
}

}  // namespace

std::optional<InputFinding> check_loop_stamps(const std::vector<double>& loops,
                                              const Trajectory& poses) {
  constexpr double kSome = 0.5, kMost = 0.9, kLeastSpan = 0.05;
  constexpr std::size_t kFewest = 6, kTried = 20'000;
  if (loops.empty() || poses.empty()) return std::nullopt;
  const double as_read = found_part(loops, poses, 1.0, 0.0);
  if (as_read > kSome) return std::nullopt;
  const auto range = std::ranges::minmax(loops);
  const double first = range.min, last = range.max;
  const double begin = poses.front().stamp, end = poses.back().stamp;
  const auto finding = [&](const std::string& change, const std::string& fix, double value) {
    return InputFinding{Fault::loop_stamps,
                        fmt::format("{:.0f} % of the loops' stamps ({:.15g} to {:.15g}) are "
                                    "those of poses ({:.3f} to {:.3f}){}",
                                    100.0 * as_read,
                                    first,
                                    last,
                                    begin,
                                    end,
                                    change),
                        fix,
                        1.0 - as_read,
                        value};
  };
  for (const double factor : {1e-3, 1e-6, 1e-9}) {
    const double part = found_part(loops, poses, factor, 0.0);
    if (part < kMost || factor * (last - first) < kLeastSpan * (end - begin)) continue;
    return finding(fmt::format("; times {:g}, {:.0f} %", factor, 100.0 * part),
                   "write the stamps of the loops in seconds",
                   1.0 / factor);
  }
  const auto is_whole = [](double stamp) { return stamp == std::round(stamp); };
  if (first >= 0.0 && last <= static_cast<double>(poses.size()) && last < begin &&
      std::ranges::all_of(loops, is_whole)) {
    return finding(": they are numbers of poses or frames", "write the stamps of the poses", last);
  }
  std::size_t fitting = 0;
  double offset = 0.0;
  for (std::size_t i = 0; i < poses.size(); i += poses.size() / kTried + 1) {
    const double each = poses[i].stamp - loops.front();
    if (loops.size() < kFewest || found_part(loops, poses, 1.0, each) < kMost) continue;
    ++fitting;
    offset = each;
  }
  if (fitting == 1) {
    return finding(fmt::format("; {:.3f} s later, at least {:.0f} %", offset, 100.0 * kMost),
                   "write the loops with the clock of the trajectory",
                   offset);
  }
  return finding("", "give the loops of this trajectory, with its stamps", begin - first);
}

}  // namespace loopbench::metrics
