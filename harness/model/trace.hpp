/// What a report draws: poses along the way, thinned, small enough to keep for every cell.
///
/// Plain structs of float32, stored as they lie in memory, little endian, one after another
/// (harness/store/traces.hpp reads them back). Stamps and positions are relative to the origin of
/// the sequence, so that float32 suffices far from zero.
#pragma once

#include <vector>

#include "datasets/core/sequence.hpp"
#include "metrics/evaluation/evaluation.hpp"

namespace loopbench {

/// Most samples of a list that are kept; longer ones are thinned evenly, both ends kept.
inline constexpr std::size_t kTraceSamples = 2000;

/// 8 floats.
struct TracePose {
  float stamp = 0;                       ///< after the origin [s]
  float x = 0, y = 0, z = 0;             ///< [m]
  float qx = 0, qy = 0, qz = 0, qw = 1;  ///< world_from_body
};

/// 12 floats: a judged pose of the estimate and how far it is from its reference.
struct TraceSample {
  TracePose estimate;                           ///< aligned; stamp of its reference
  float error_x = 0, error_y = 0, error_z = 0;  ///< estimate minus reference [m]
  float error_angle = 0;                        ///< of the rotation between the two [deg]
};

/// 8 floats: the keyframes a loop closure joins, where the tracker left them.
struct TraceClosure {
  float from_stamp = 0, to_stamp = 0;        ///< after the origin [s]
  float from_x = 0, from_y = 0, from_z = 0;  ///< [m]
  float to_x = 0, to_y = 0, to_z = 0;        ///< [m]
};
static_assert(sizeof(TracePose) == 32 && sizeof(TraceSample) == 48 && sizeof(TraceClosure) == 32);

/// What stamps and positions of a sequence's traces are measured from: its first reference pose.
struct TraceOrigin {
  double stamp = 0.0;                ///< [s]
  double x = 0.0, y = 0.0, z = 0.0;  ///< in the world of the reference [m]
};

struct SequenceTrace {
  TraceOrigin origin;
  std::vector<TracePose> reference;
  /// As the tracker left them, in the tracker's own world: positions are not moved by the origin.
  std::vector<TracePose> keyframes;
  std::vector<TraceClosure> closures;  ///< all of them, positions as for keyframes
};

struct CellTrace {
  Times times = Times::dense;        ///< where it was judged
  std::vector<TraceSample> samples;  ///< empty: nothing was judged
};

TraceOrigin trace_origin(const Sequence& sequence);
SequenceTrace sequence_trace(const Sequence& sequence);
CellTrace cell_trace(const Evaluation& evaluation, Times times, const TraceOrigin& origin);

}  // namespace loopbench
