#include "harness/eval/common_parts.hpp"

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
#include "harness/eval/arguments.hpp"
#include "harness/eval/recorded_file.hpp"
#include "harness/eval/recorded_runs.hpp"
#include "metrics/numerics/median.hpp"
#include "metrics/pairing/association.hpp"

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

using AlignedRuns = std::pair<std::string, std::string>;  // method and run; empty: all files

void require_least_squares(const metrics::NamedProtocol& protocol) {
  const metrics::Align type = protocol.rules.align;
  const bool is_fitted = type == metrics::Align::se3 || type == metrics::Align::sim3 ||
                         type == metrics::Align::scale || type == metrics::Align::posyaw;
  if (is_fitted && protocol.rules.align_first == 0) return;
  throw InputError("--align-together: protocol " + protocol.label() +
                   " does not align by least squares of all pairs, expected --align se3, sim3, "
                   "scale or posyaw");
}

void append(metrics::Paired& all, const metrics::Paired& more) {
  all.reference.insert(all.reference.end(), more.reference.begin(), more.reference.end());
  all.estimate.insert(all.estimate.end(), more.estimate.begin(), more.estimate.end());
}

}  // namespace

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

std::vector<std::vector<metrics::Alignment>> common_alignments(const RecordedSweep& files) {
  const std::vector<metrics::NamedProtocol>& protocols = files.sweep.protocols;
  std::ranges::for_each(protocols, require_least_squares);
  const bool has_one = std::ranges::all_of(files.runs, [&](const RecordedRun& run) {
    return run.reference == files.runs.front().reference;
  });
  const auto group_of = [&](const RecordedRun& run) {
    return has_one ? AlignedRuns() : AlignedRuns(run.method, run.run);
  };
  std::map<AlignedRuns, std::vector<metrics::Paired>> pairs;  // of each protocol
  std::string why;
  for (const RecordedRun& run : files.runs) {
    std::vector<metrics::Paired>& of_group = pairs[group_of(run)];
    of_group.resize(protocols.size());
    try {
      const RecordedFile reference = recorded_reference(run.reference, files.arguments, false);
      const RecordedFile estimate =
          recorded_estimate(run.estimate, files.arguments, false, &reference);
      for (std::size_t p = 0; p < protocols.size(); ++p) {
        append(of_group[p],
               metrics::associate(reference.poses, estimate.poses, protocols[p].rules));
      }
    } catch (const std::runtime_error& error) {
      why = error.what();  // its evaluation fails, too
    }
  }
  std::map<AlignedRuns, std::vector<metrics::Alignment>> fitted;
  for (const auto& [group, of_group] : pairs) {
    for (std::size_t p = 0; p < protocols.size(); ++p) {
      try {
        fitted[group].push_back(
            align(of_group[p].reference, of_group[p].estimate, protocols[p].rules.align));
      } catch (const std::exception& error) {
        throw InputError("--align-together: " + (why.empty() ? error.what() : why));
      }
    }
  }
  std::vector<std::vector<metrics::Alignment>> out;
  for (const RecordedRun& run : files.runs) out.push_back(fitted.at(group_of(run)));
  return out;
}

}  // namespace loopbench::harness
