#include "harness/eval/recordings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "datasets/core/error.hpp"
#include "datasets/core/parallel.hpp"
#include "harness/eval/recorded_file.hpp"
#include "metrics/alignment/alignment.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

/// Position at a time within the trajectory, linear between poses.
StampedPose position_at(const Trajectory& poses, double time) {
  const auto next = std::ranges::lower_bound(poses, time, {}, &StampedPose::stamp);
  if (next == poses.begin()) return poses.front();
  if (next == poses.end()) return poses.back();
  const StampedPose& before = *(next - 1);
  const double share = (time - before.stamp) / (next->stamp - before.stamp);
  StampedPose out{time, {}};
  out.world_from_body.translation = before.world_from_body.translation * (1.0 - share) +
                                    next->world_from_body.translation * share;
  return out;
}

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

bool is_same_recording(const Trajectory& one, const Trajectory& other) {
  constexpr std::size_t kSamples = 200;
  constexpr double kShare = 0.01;
  const double begin = std::max(one.front().stamp, other.front().stamp);
  const double end = std::min(one.back().stamp, other.back().stamp);
  const double shorter =
      std::min(one.back().stamp - one.front().stamp, other.back().stamp - other.front().stamp);
  if (!(shorter > 0.0) || end - begin < 0.5 * shorter) return false;
  Trajectory ones;
  Trajectory others;
  Vector3 center = Vector3::Zero();
  for (std::size_t i = 0; i < kSamples; ++i) {
    const double time = begin + (end - begin) * static_cast<double>(i) / (kSamples - 1);
    ones.push_back(position_at(one, time));
    others.push_back(position_at(other, time));
    center += ones.back().world_from_body.translation / static_cast<double>(kSamples);
  }
  try {
    others = metrics::moved(metrics::align(ones, others, metrics::Align::se3), others);
  } catch (const std::runtime_error&) {
    return false;  // at rest or on a straight line, which are no evidence
  }
  double differences = 0.0;
  double spread = 0.0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const Vector3& position = ones[i].world_from_body.translation;
    differences += (position - others[i].world_from_body.translation).squaredNorm();
    spread += (position - center).squaredNorm();
  }
  return differences < kShare * kShare * spread;
}

std::string Recordings::name_of(const std::string& content, const Trajectory& reference) {
  for (const auto& [name, poses] : known_) {
    if (name == content || is_same_recording(poses, reference)) return name;
  }
  known_.emplace_back(content, reference);
  return content;
}

void set_common_times(std::vector<RecordedRun>& runs, const EvalArguments& arguments) {
  std::vector<std::vector<TimeRange>> covered(runs.size());
  parallel_for_tasks(runs.size(), [&](std::size_t i) {
    try {
      covered[i] = covered_times(recorded_estimate(runs[i].estimate, arguments, false).poses);
    } catch (const InputError&) {
      covered[i].clear();  // its evaluation fails, too, and states why
    }
  });
  std::map<std::string, std::vector<std::vector<TimeRange>>> by_reference;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    by_reference[runs[i].reference].push_back(covered[i]);
  }
  for (RecordedRun& run : runs) run.common = common_times(by_reference.at(run.reference));
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
