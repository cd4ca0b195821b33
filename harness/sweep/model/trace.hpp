/// Poses of a cell or sequence for the report's plots: as many as its curves need.
///
/// Plain structs of float32. Stamps and positions are relative to the origin of the sequence, so
/// that float32 is sufficient far from zero. Stores have them rounded and compressed
/// (harness/sweep/model/packed_columns.hpp, a column for each member in order), but closures, which
/// are raw memory, little endian; harness/sweep/store/traces.hpp reads them.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/sequence.hpp"
#include "harness/sweep/model/kept_rows.hpp"
#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::harness {

/// Deviation of stored curves from all their poses, in shares of a figure; with the rounding of
/// stored numbers, it stays below 0.002.
inline constexpr double kTraceDeviation = 1.8e-3;

/// Evenly spaced poses of the trajectories of a sequence; more are kept where their curves need it.
inline constexpr std::size_t kTraceSamples = 2000;

/// 5 floats.
struct TracePose {
  float stamp = 0;            ///< relative to the origin [s]
  float distance = 0;         ///< along the path from its first pose, over all poses [m]
  float x = 0, y = 0, z = 0;  ///< [m]
};

/// 9 floats: an evaluated pose of the estimate and its error.
struct TraceSample {
  TracePose estimate;  ///< aligned; with the stamp and the distance of its reference
  float error_x = 0, error_y = 0, error_z = 0;  ///< estimate minus reference [m]
  float error_angle = 0;                        ///< rotation error [deg]; NaN: without rotations
};

/// 8 floats: the keyframes of a loop closure, before correction.
struct TraceClosure {
  float from_stamp = 0, to_stamp = 0;        ///< relative to the origin [s]
  float from_x = 0, from_y = 0, from_z = 0;  ///< [m]
  float to_x = 0, to_y = 0, to_z = 0;        ///< [m]
};
static_assert(sizeof(TracePose) == 20 && sizeof(TraceSample) == 36 && sizeof(TraceClosure) == 32);

/// Origin of stamps and positions in a sequence's traces: its first reference pose.
struct TraceOrigin {
  double stamp = 0.0;                ///< [s]
  double x = 0.0, y = 0.0, z = 0.0;  ///< in the reference's world frame [m]
};

struct SequenceTrace {
  TraceOrigin origin;
  std::vector<TracePose> reference;
  /// Before correction, in the tracker's own world frame: positions are not relative to the origin.
  std::vector<TracePose> keyframes;
  std::vector<TraceClosure> closures;  ///< all closures, positions as for keyframes
  std::string ledger;                  ///< of the closures, stored_ledger()
};

/// Values that a metric gave for each evaluated pose.
struct TraceValues {
  std::string name;  ///< of the metric and its score
  std::string unit;
  std::vector<float> values;  ///< at the samples of the cell's trace
};

struct CellTrace {
  metrics::Times times = metrics::Times::dense;  ///< evaluation times
  std::vector<TraceSample> samples;              ///< empty if nothing was evaluated
  std::vector<TraceValues> values{};
};

/// What a score states for each evaluated pose.
struct PoseValues {
  std::string name;  ///< label of the metric, with relation and axis
  std::string unit;
  std::vector<double> values;  ///< one for each pair
};

TraceOrigin trace_origin(const Sequence& sequence);
SequenceTrace sequence_trace(const Sequence& sequence);

/// The evaluated poses and the values of metrics there. Between two poses that are kept, each
/// curve is a line that deviates from all poses by at most kTraceDeviation of its figure: positions
/// (in shares of their largest extent; heights also if they are drawn enlarged), and the errors and
/// values over time and distance (in shares of their own range, at least 1e-6). O(n log n).
CellTrace cell_trace(const metrics::Evaluation& evaluation,
                     metrics::Times times,
                     const TraceOrigin& origin,
                     const std::vector<PoseValues>& values);

/// The same with fewer poses: each curve deviates by at most `deviation` from the given one.
CellTrace thinned(const CellTrace& trace, double deviation);

/// At least `even` evenly spaced poses, and those without which a curve would deviate by more than
/// half of kTraceDeviation: stores and pages thin one after the other.
std::vector<TracePose> thinned(const std::vector<TracePose>& poses, std::size_t even);

}  // namespace loopbench::harness
