/// Position and rotation error along and about each axis of the reference's world frame.
#pragma once

#include <cmath>

#include "datasets/core/parallel.hpp"
#include "metrics/errors/ape.hpp"
#include "metrics/metric.hpp"

namespace loopbench::metrics {

struct AxisErrorOptions {
  bool rotation = false;
};

template <class Visit>
void fields(AxisErrorOptions& o, Visit visit) {
  visit("rotation", o.rotation, "also compute roll, pitch and yaw errors");
}

/// translation x, y, z [m]: |p_estimate - p_reference| along the axis. The squares of the three
/// rmse values add up to the squared 3-D rmse. The values depend on the orientation of the world
/// frame, and min depends mostly on the sample count. With `rotation`, the scores of ape's rpy
/// follow. O(n).
inline std::vector<Score> axis_error(const Evaluation& evaluation,
                                     const AxisErrorOptions& options) {
  const std::size_t n = evaluation.reference.size();
  std::array<std::vector<double>, 3> metres;
  for (std::vector<double>& axis : metres) axis.resize(n);
  parallel_for_blocks(n, [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      const Vector3 error = evaluation.estimate[i].world_from_body.translation -
                            evaluation.reference[i].world_from_body.translation;
      for (int a = 0; a < 3; ++a) metres[static_cast<std::size_t>(a)][i] = std::abs(error[a]);
    }
  });
  const int ddof = evaluation.protocol.ddof;
  std::vector<Score> out{{"translation", "x", "m", statistics(std::move(metres[0]), ddof)},
                         {"translation", "y", "m", statistics(std::move(metres[1]), ddof)},
                         {"translation", "z", "m", statistics(std::move(metres[2]), ddof)}};
  if (!options.rotation) return out;
  for (Score& rotation_score : ape(evaluation, {Relation::rpy}))
    out.push_back(std::move(rotation_score));
  return out;
}

}  // namespace loopbench::metrics
