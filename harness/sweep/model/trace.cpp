#include "harness/sweep/model/trace.hpp"

#include <cmath>
#include <deque>
#include <limits>
#include <utility>

#include "harness/sweep/model/loops.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::harness {
namespace {

constexpr double kLeastRange = 1e-6;  // of a figure [m, deg, unit of a metric]

float single(double value) { return static_cast<float>(value); }

TracePose small(const StampedPose& pose, double distance, const TraceOrigin& origin) {
  const Vector3& p = pose.world_from_body.translation;
  return {single(pose.stamp - origin.stamp),
          single(distance),
          single(p.x() - origin.x),
          single(p.y() - origin.y),
          single(p.z() - origin.z)};
}

/// All poses with their distances.
std::vector<TracePose> poses(const Trajectory& trajectory, const TraceOrigin& origin) {
  std::vector<TracePose> out;
  out.reserve(trajectory.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const Vector3& position = trajectory[i].world_from_body.translation;
    if (i > 0) distance += (position - trajectory[i - 1].world_from_body.translation).norm();
    out.push_back(small(trajectory[i], distance, origin));
  }
  return out;
}

std::vector<TraceSample> samples(const metrics::Evaluation& evaluation, const TraceOrigin& origin) {
  std::vector<TraceSample> out;
  out.reserve(evaluation.reference.size());
  for (const TracePose& reference : poses(evaluation.reference, origin)) {
    const Pose& expected = evaluation.reference[out.size()].world_from_body;
    const Pose& estimate = evaluation.estimate[out.size()].world_from_body;
    const Vector3 error = estimate.translation - expected.translation;
    const double angle = angle_between(expected.rotation, estimate.rotation);
    const StampedPose aligned{evaluation.reference[out.size()].stamp, estimate};
    out.push_back({small(aligned, reference.distance, origin),
                   single(error.x()),
                   single(error.y()),
                   single(error.z()),
                   single(angle * metrics::kDegrees)});
  }
  return out;
}

/// Columns of lists of rows, in shares of figures, and the lines that are drawn through them.
template <class Row>
class DrawnLines {
 public:
  DrawnLines(const std::vector<Row>& rows, double deviation) : rows_(rows), deviation_(deviation) {}

  /// Maps of positions with equal scales, and in space, where heights are enlarged if the extent
  /// along them is small.
  template <class Position>
  void add_map(const Position& position) {
    constexpr double kHeight = 0.15, kMostEnlarged = 20.0;  // of page/space.js
    std::vector<double> sizes;
    for (int axis = 0; axis < 3; ++axis) {
      const auto [low, high] = range([&](const Row& row) { return position(row)[axis]; });
      sizes.push_back(std::max(0.0, high - low));
    }
    const double size = std::max(std::ranges::max(sizes), kLeastRange);
    DrawnLine map{{}, deviation_};
    for (int axis = 0; axis < 3; ++axis) {
      const double own = std::max(sizes[static_cast<std::size_t>(axis)], kLeastRange);
      const double enlarged = std::clamp(kHeight * size / own, 1.0, kMostEnlarged);
      map.axes.emplace_back(column([&](const Row& row) { return position(row)[axis]; },
                                   std::max(size / enlarged, kLeastRange)));
    }
    lines.push_back(std::move(map));
  }

  /// `value` over time and distance.
  template <class Pose, class Value>
  void add_over(const Pose& pose, const Value& value) {
    if (time_.empty()) {
      const auto stamp = [&](const Row& row) { return pose(row).stamp; };
      const auto distance = [&](const Row& row) { return pose(row).distance; };
      time_ = column(stamp, size_of(stamp));
      distance_ = column(distance, size_of(distance));
    }
    const std::span<const double> values = column(value, size_of(value));
    lines.push_back({{time_, distance_, values}, deviation_});
    if (values.empty()) return;
    const auto [low, high] = std::ranges::minmax_element(values);
    for (const auto extreme : {low, high}) {
      extremes.push_back(static_cast<std::size_t>(extreme - values.begin()));
    }
  }

  std::vector<DrawnLine> lines;
  std::vector<std::size_t> extremes;  ///< rows of the least and the greatest values

 private:
  template <class Value>
  std::pair<double, double> range(const Value& value) const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Row& row : rows_) {
      const double found = value(row);
      if (!std::isfinite(found)) continue;
      low = std::min(low, found);
      high = std::max(high, found);
    }
    return {low, high};
  }

  template <class Value>
  double size_of(const Value& value) const {
    const auto [low, high] = range(value);
    return std::max(high - low, kLeastRange);
  }

  template <class Value>
  std::span<const double> column(const Value& value, double size) {
    std::vector<double>& out = columns_.emplace_back();
    out.reserve(rows_.size());
    for (const Row& row : rows_) {
      const double found = value(row) / size;
      out.push_back(std::isfinite(found) ? found : std::numeric_limits<double>::quiet_NaN());
    }
    return out;
  }

  const std::vector<Row>& rows_;
  double deviation_;
  std::deque<std::vector<double>> columns_;
  std::span<const double> time_, distance_;
};

Vector3 position_of(const TracePose& pose) { return {pose.x, pose.y, pose.z}; }

/// The pose with the largest position error of at least one.
std::size_t farthest_off(const std::vector<TraceSample>& all) {
  const auto square = [](const TraceSample& s) {
    return s.error_x * s.error_x + s.error_y * s.error_y + s.error_z * s.error_z;
  };
  return static_cast<std::size_t>(std::ranges::max_element(all, {}, square) - all.begin());
}

template <class Item>
std::vector<Item> selected(const std::vector<Item>& all, const std::vector<std::size_t>& rows) {
  std::vector<Item> out;
  out.reserve(rows.size());
  for (const std::size_t i : rows) out.push_back(all[i]);
  return out;
}

}  // namespace

TraceOrigin trace_origin(const Sequence& sequence) {
  if (sequence.reference.empty()) {
    const Trajectory& keyframes = sequence.problem.keyframes;
    return {keyframes.empty() ? 0.0 : keyframes.front().stamp, 0.0, 0.0, 0.0};
  }
  const StampedPose& first = sequence.reference.front();
  const Vector3& p = first.world_from_body.translation;
  return {first.stamp, p.x(), p.y(), p.z()};
}

SequenceTrace sequence_trace(const Sequence& sequence) {
  SequenceTrace out;
  out.origin = trace_origin(sequence);
  out.reference = thinned(poses(sequence.reference, out.origin), kTraceSamples);
  const TraceOrigin own{out.origin.stamp, 0.0, 0.0, 0.0};
  const std::vector<TracePose> keyframes = poses(sequence.problem.keyframes, own);
  out.keyframes = thinned(keyframes, kTraceSamples);
  for (const Edge& loop : sequence.problem.closures) {
    const TracePose& from = keyframes[loop.from];
    const TracePose& to = keyframes[loop.to];
    out.closures.push_back({from.stamp, to.stamp, from.x, from.y, from.z, to.x, to.y, to.z});
  }
  out.ledger = stored_ledger(sequence.problem);
  return out;
}

CellTrace cell_trace(const metrics::Evaluation& evaluation,
                     metrics::Times times,
                     const TraceOrigin& origin,
                     const std::vector<PoseValues>& values) {
  CellTrace out{times, samples(evaluation, origin)};
  for (const PoseValues& each : values) {
    TraceValues& added = out.values.emplace_back();
    added.name = each.name;
    added.unit = each.unit;
    for (const double value : each.values) added.values.push_back(single(value));
    added.values.resize(out.samples.size(), std::numeric_limits<float>::quiet_NaN());
  }
  return thinned(out, kTraceDeviation);
}

CellTrace thinned(const CellTrace& trace, double deviation) {
  const std::vector<TraceSample>& all = trace.samples;
  if (all.empty()) return trace;
  DrawnLines<TraceSample> drawn(all, deviation);
  const auto pose = [](const TraceSample& s) { return s.estimate; };
  const auto index = [&](const TraceSample& s) {
    return static_cast<std::size_t>(&s - all.data());
  };
  drawn.add_map([](const TraceSample& s) { return position_of(s.estimate); });
  drawn.add_over(pose, [](const TraceSample& s) { return s.error_x; });
  drawn.add_over(pose, [](const TraceSample& s) { return s.error_y; });
  drawn.add_over(pose, [](const TraceSample& s) { return s.error_z; });
  drawn.add_over(pose, [](const TraceSample& s) { return s.error_angle; });
  for (const TraceValues& each : trace.values) {
    drawn.add_over(pose, [&](const TraceSample& s) { return each.values[index(s)]; });
  }
  std::vector<std::size_t> kept = subsampled_indices(all.size(), 2);
  kept.insert(kept.end(), drawn.extremes.begin(), drawn.extremes.end());
  kept.push_back(farthest_off(all));
  sort_unique(kept);
  keep_deviating(kept, drawn.lines);
  CellTrace out{trace.times, selected(all, kept)};
  for (const TraceValues& each : trace.values) {
    out.values.push_back({each.name, each.unit, selected(each.values, kept)});
  }
  return out;
}

std::vector<TracePose> thinned(const std::vector<TracePose>& poses, std::size_t even) {
  DrawnLines<TracePose> drawn(poses, 0.5 * kTraceDeviation);
  drawn.add_map(position_of);
  // The distance over time is within the line of any value.
  drawn.add_over([](const TracePose& p) { return p; }, [](const TracePose&) { return 0.0F; });
  std::vector<std::size_t> kept = subsampled_indices(poses.size(), even);
  keep_deviating(kept, drawn.lines);
  return selected(poses, kept);
}

}  // namespace loopbench::harness
