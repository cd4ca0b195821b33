/// Subsampled poses of a cell or sequence for the report's plots.
///
/// Plain structs of float32, stored as raw memory, little endian, one after another
/// (harness/sweep/store/traces.hpp reads them). Stamps and positions are relative to the origin of
/// the sequence, so that float32 is sufficient far from zero.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "datasets/core/sequence.hpp"
#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::harness {

/// Maximum number of stored samples; longer lists are subsampled evenly, including both ends.
inline constexpr std::size_t kTraceSamples = 2000;

/// At most `most` evenly spaced indices of 0..count-1, including both ends.
inline std::vector<std::size_t> subsampled_indices(std::size_t count, std::size_t most) {
  const std::size_t kept = std::min(count, most);
  std::vector<std::size_t> out(kept);
  for (std::size_t i = 0; i < kept; ++i) out[i] = kept == 1 ? 0 : i * (count - 1) / (kept - 1);
  return out;
}

/// 8 floats.
struct TracePose {
  float stamp = 0;                       ///< relative to the origin [s]
  float x = 0, y = 0, z = 0;             ///< [m]
  float qx = 0, qy = 0, qz = 0, qw = 1;  ///< world_from_body
};

/// 12 floats: an evaluated pose of the estimate and its error.
struct TraceSample {
  TracePose estimate;                           ///< aligned; with the stamp of its reference
  float error_x = 0, error_y = 0, error_z = 0;  ///< estimate minus reference [m]
  float error_angle = 0;                        ///< rotation error [deg]
};

/// 8 floats: the keyframes of a loop closure, before correction.
struct TraceClosure {
  float from_stamp = 0, to_stamp = 0;        ///< relative to the origin [s]
  float from_x = 0, from_y = 0, from_z = 0;  ///< [m]
  float to_x = 0, to_y = 0, to_z = 0;        ///< [m]
};
static_assert(sizeof(TracePose) == 32 && sizeof(TraceSample) == 48 && sizeof(TraceClosure) == 32);

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

TraceOrigin trace_origin(const Sequence& sequence);
SequenceTrace sequence_trace(const Sequence& sequence);
CellTrace cell_trace(const metrics::Evaluation& evaluation,
                     metrics::Times times,
                     const TraceOrigin& origin);

/// Adds values of a metric, one for each pose that cell_trace() evaluated.
void add_values(CellTrace& trace,
                std::string name,
                std::string unit,
                const std::vector<double>& per_pose);

}  // namespace loopbench::harness
