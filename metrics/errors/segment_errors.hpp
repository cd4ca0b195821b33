/// The errors of sub-trajectories of one length, before they are summed up.
#pragma once

#include <vector>

#include "metrics/evaluation/evaluation.hpp"
#include "metrics/pairing/pair_search.hpp"

namespace loopbench {

/// Equally long, or empty: `start` in float64, the last four when only rates are wanted and in
/// float32.
struct SegmentErrors {
  std::vector<std::size_t> start;
  std::vector<double> translation_share;  ///< [m/m]
  std::vector<double> rotation_rate;      ///< [rad/m]
  std::vector<double> translation;        ///< [m]
  std::vector<double> rotation;           ///< [rad]
  std::vector<double> yaw;                ///< [rad], magnitude
  std::vector<double> gravity;            ///< [rad]
};

/// By the protocol, on all cores. Poses that both stand in KITTI files and that nothing has moved
/// since count with the digits of the files and general inverses, as in the devkit: making
/// rotations of them first shifts the mean angle by 2e-9 of it.
SegmentErrors segment_errors(const Evaluation& evaluation,
                             const std::vector<double>& distances,
                             const std::vector<FromTo>& pairs,
                             double length,
                             bool only_rates);

/// The devkit's, with matrices as above: distances, angles and lengths of translations in float,
/// transforms in double.
std::vector<float> float_distances(const Trajectory& trajectory);
SegmentErrors float_segment_errors(const Evaluation& evaluation,
                                   const std::vector<FromTo>& pairs,
                                   float length);

/// Sum in float, term by term, over the count.
double float_mean(const std::vector<double>& values);

}  // namespace loopbench
