#include "methods/smoothers/runs/pose_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "datasets/core/knot_span.hpp"
#include "datasets/core/median_interval.hpp"
#include "datasets/core/polyline.hpp"

namespace loopbench::methods {
namespace {

class JoinedCurve final : public Curve {
 public:
  explicit JoinedCurve(std::vector<std::unique_ptr<const Curve>> pieces)
      : pieces_(std::move(pieces)) {
    for (const auto& piece : pieces_) begins_.push_back(piece->start());
    begins_.push_back(pieces_.back()->end());
  }

  double start() const override { return begins_.front(); }
  double end() const override { return begins_.back(); }

  using Curve::sample;
  void sample(std::span<const double> times, std::span<Pose> poses) const override {
    KnotSpan span(begins_);
    for (std::size_t first = 0; first < times.size();) {
      const std::size_t piece = span.find(times[first]);
      std::size_t last = first + 1;
      while (last < times.size() && span.find(times[last]) == piece) ++last;
      pieces_[piece]->sample(times.subspan(first, last - first),
                             poses.subspan(first, last - first));
      first = last;
    }
  }

 private:
  std::vector<std::unique_ptr<const Curve>> pieces_;
  std::vector<double> begins_;  ///< start of each piece, and the end of the last
};

Trajectory part_of(const Trajectory& poses, const PoseRun& run) {
  const auto begin = poses.begin() + static_cast<std::ptrdiff_t>(run.first);
  return {begin, begin + static_cast<std::ptrdiff_t>(run.last - run.first + 1)};
}

double step_angle(const Trajectory& poses, std::size_t i) {
  return angle_between(poses[i].world_from_body.rotation, poses[i + 1].world_from_body.rotation);
}

using Solve = std::function<std::unique_ptr<const Curve>(const Trajectory&)>;

void add_rotations(const Trajectory& poses,
                   const PoseRun& run,
                   const Solve& solve,
                   std::vector<std::unique_ptr<const Curve>>& parts) {
  if (run.first == run.last) {
    parts.push_back(std::make_unique<Polyline>(part_of(poses, run)));
    return;
  }
  if (auto curve = solve(part_of(poses, run))) {
    parts.push_back(std::move(curve));
    return;
  }
  std::size_t largest = run.first;
  for (std::size_t i = run.first; i < run.last; ++i) {
    if (step_angle(poses, i) > step_angle(poses, largest)) largest = i;
  }
  add_rotations(poses, {run.first, largest}, solve, parts);
  add_rotations(poses, {largest + 1, run.last}, solve, parts);
}

}  // namespace

std::vector<PoseRun> runs_without_breaks(std::size_t poses,
                                         const std::function<bool(std::size_t)>& cut) {
  std::vector<PoseRun> out{{0, 0}};
  for (std::size_t i = 0; i + 1 < poses; ++i) {
    if (cut(i)) {
      out.push_back({i + 1, i + 1});
    } else {
      out.back().last = i + 1;
    }
  }
  return out;
}

std::unique_ptr<const Curve> joined(std::vector<std::unique_ptr<const Curve>> parts) {
  std::vector<std::unique_ptr<const Curve>> pieces;
  std::optional<StampedPose> previous_end;
  for (auto& part : parts) {
    const StampedPose begin{part->start(), part->at(part->start())};
    const StampedPose end{part->end(), part->at(part->end())};
    if (previous_end)
      pieces.push_back(std::make_unique<Polyline>(Trajectory{*previous_end, begin}));
    if (begin.stamp < end.stamp) pieces.push_back(std::move(part));
    previous_end = end;
  }
  return std::make_unique<JoinedCurve>(std::move(pieces));
}

std::unique_ptr<const Curve> smooth_segments(
    const Trajectory& poses,
    const std::vector<PoseRun>& runs,
    const std::string& reason,
    Report& report,
    const std::function<std::unique_ptr<const Curve>(Trajectory, Report&)>& smooth) {
  if (runs.size() == 1) return smooth(poses, report);
  std::vector<std::unique_ptr<const Curve>> parts;
  std::vector<Count> counts;
  std::vector<Matrix6> covariances;
  std::size_t longest = 0;
  for (const PoseRun& run : runs) {
    Report part_report;
    parts.push_back(smooth(part_of(poses, run), part_report));
    std::ranges::move(part_report.phases, std::back_inserter(report.phases));
    std::ranges::move(part_report.sections, std::back_inserter(report.sections));
    std::ranges::move(part_report.notes, std::back_inserter(report.notes));
    std::ranges::move(part_report.covariances, std::back_inserter(covariances));
    const std::size_t size = run.last - run.first + 1;
    if (size > longest) {
      longest = size;
      counts = std::move(part_report.counts);
    }
  }
  std::ranges::move(counts, std::back_inserter(report.counts));
  if (covariances.size() == poses.size()) report.covariances = std::move(covariances);
  report.count("chords", static_cast<double>(runs.size() - 1));
  const double begin = poses[runs[0].last].stamp;
  const double end = poses[runs[1].first].stamp;
  report.notes.push_back(
      fmt::format("{}: {} bridged by a chord, the first from {:.6f} s to {:.6f} s",
                  reason,
                  runs.size() - 1,
                  begin,
                  end));
  return joined(std::move(parts));
}

std::unique_ptr<const Curve> smooth_between_short_intervals(
    const Trajectory& poses,
    Report& report,
    const std::function<std::unique_ptr<const Curve>(Trajectory, Report&)>& smooth) {
  if (poses.size() < 2) return smooth(poses, report);
  const double shortest = kShortestInterval * median_interval(poses);
  const auto segments = runs_without_breaks(
      poses.size(), [&](std::size_t i) { return poses[i + 1].stamp - poses[i].stamp < shortest; });
  return smooth_segments(poses, segments, "intervals below 0.01 times the median", report, smooth);
}

std::unique_ptr<const Curve> interpolate_rotations_in_parts(const Trajectory& poses,
                                                            Report& report,
                                                            const Solve& solve) {
  constexpr double kLarge = 2.0;  // [rad]
  std::vector<std::unique_ptr<const Curve>> parts;
  const auto cut = runs_without_breaks(
      poses.size(), [&](std::size_t i) { return step_angle(poses, i) > kLarge; });
  for (const PoseRun& run : cut) add_rotations(poses, run, solve, parts);
  report.count("great_arcs", static_cast<double>(parts.size() - 1));
  report.notes.push_back(fmt::format(
      "no rotation spline through all keyframes exists: {} of {} intervals are great arcs",
      parts.size() - 1,
      poses.size() - 1));
  return joined(std::move(parts));
}

}  // namespace loopbench::methods
