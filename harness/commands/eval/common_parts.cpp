#include "harness/commands/eval/common_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "datasets/core/error.hpp"
#include "datasets/core/parallel.hpp"
#include "datasets/core/trajectory.hpp"
#include "harness/commands/eval/arguments.hpp"
#include "harness/commands/eval/evaluated_file.hpp"
#include "harness/commands/eval/evaluated_runs.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

using TimeRange = std::pair<double, double>;  ///< begin and end [s]

double duration(const std::vector<TimeRange>& ranges) {
  double out = 0.0;
  for (const auto& [begin, end] : ranges) out += end - begin;
  return out;
}

/// The times of a trajectory, split at gaps above 2 s and ten times the median interval.
std::vector<TimeRange> covered_times(const Trajectory& poses) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    intervals.push_back(poses[i].stamp - poses[i - 1].stamp);
  }
  if (intervals.empty()) return {};
  const double longest = std::max(2.0, 10.0 * metrics::median(intervals));
  std::vector<TimeRange> out{{poses.front().stamp, poses.front().stamp}};
  for (const StampedPose& pose : poses) {
    if (pose.stamp - out.back().second > longest) out.push_back({pose.stamp, pose.stamp});
    out.back().second = pose.stamp;
  }
  return out;
}

std::vector<TimeRange> intersection(const std::vector<TimeRange>& one,
                                    const std::vector<TimeRange>& other) {
  std::vector<TimeRange> out;
  for (const auto& [begin, end] : one) {
    for (const auto& [other_begin, other_end] : other) {
      const TimeRange both{std::max(begin, other_begin), std::min(end, other_end)};
      if (both.first < both.second) out.push_back(both);
    }
  }
  return out;
}

std::string common_times(const std::vector<std::vector<TimeRange>>& all) {
  constexpr double kComplete = 0.99;
  constexpr double kLeast = 0.5;
  double longest = 0.0;
  for (const auto& ranges : all) longest = std::max(longest, duration(ranges));
  const std::vector<TimeRange>* first = nullptr;
  std::vector<TimeRange> common;
  for (const auto& ranges : all) {
    if (ranges.empty() || duration(ranges) < kLeast * longest) continue;
    common = first == nullptr ? ranges : intersection(common, ranges);
    first = &ranges;
  }
  if (duration(common) >= kComplete * longest) return "";
  std::string out;
  for (const auto& [begin, end] : common) {
    out += fmt::format("{}{} {}", out.empty() ? "" : " ", begin, end);
  }
  return out;
}

}  // namespace

void set_common_times(std::vector<EvaluatedRun>& runs, const EvalArguments& arguments) {
  std::vector<std::vector<TimeRange>> covered(runs.size());
  parallel_for_tasks(runs.size(), [&](std::size_t i) {
    try {
      covered[i] = covered_times(evaluated_estimate(runs[i].estimate, arguments, false).poses);
    } catch (const InputError&) {
      covered[i].clear();  // its evaluation fails, too, and states why
    }
  });
  std::map<std::string, std::vector<std::vector<TimeRange>>> by_reference;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    by_reference[runs[i].reference].push_back(covered[i]);
  }
  for (EvaluatedRun& run : runs) run.common = common_times(by_reference.at(run.reference));
}

Trajectory poses_within(const Trajectory& poses, const std::string& common) {
  std::vector<TimeRange> ranges;
  std::istringstream in(common);
  for (TimeRange range; in >> range.first >> range.second;) ranges.push_back(range);
  Trajectory out;
  std::ranges::copy_if(poses, std::back_inserter(out), [&](const StampedPose& pose) {
    return std::ranges::any_of(ranges, [&](const TimeRange& range) {
      return range.first <= pose.stamp && pose.stamp <= range.second;
    });
  });
  return out;
}

}  // namespace loopbench::harness
