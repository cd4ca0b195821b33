/// Errors of the sub-trajectories of one length.
#pragma once

#include <vector>

#include "metrics/evaluation/evaluation.hpp"
#include "metrics/pairing/pair_search.hpp"

namespace loopbench::metrics {

/// Lists of equal length or empty. `start` is empty in float64. The last four are empty if only
/// rates are requested, and in float32.
struct SegmentErrors {
  std::vector<std::size_t> start;
  std::vector<double> translation_share;  ///< [m/m]
  std::vector<double> rotation_rate;      ///< [rad/m]
  std::vector<double> translation;        ///< [m]
  std::vector<double> rotation;           ///< [rad]
  std::vector<double> yaw;                ///< [rad], magnitude
  std::vector<double> gravity;            ///< [rad]
};

/// Errors by the protocol, multi-threaded. Poses from KITTI files that were not moved since are
/// used with the printed digits and general matrix inverses, as in the devkit: converting them to
/// rotations first changes the mean angle by a relative 2e-9.
SegmentErrors segment_errors(const Evaluation& evaluation,
                             const std::vector<double>& distances,
                             const std::vector<FromTo>& pairs,
                             double length,
                             bool only_rates);

/// The devkit's float variant, with matrices as above: distances, angles and translation lengths in
/// float, transforms in double.
std::vector<float> float_distances(const Trajectory& trajectory);
SegmentErrors float_segment_errors(const Evaluation& evaluation,
                                   const std::vector<FromTo>& pairs,
                                   float length);

/// Mean with a sequential sum in float.
double float_mean(const std::vector<double>& values);

}  // namespace loopbench::metrics
