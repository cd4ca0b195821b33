/// Selection of the pose pairs of a relative error by the protocol's rule.
#pragma once

#include "metrics/pairing/pair_search.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench::metrics {

enum class DeltaUnit { frames, s, m, deg, rad };
inline auto choices(DeltaUnit) {
  return std::array{std::pair{"frames", DeltaUnit::frames},
                    std::pair{"s", DeltaUnit::s},
                    std::pair{"m", DeltaUnit::m},
                    std::pair{"deg", DeltaUnit::deg},
                    std::pair{"rad", DeltaUnit::rad}};
}

struct PairDelta {
  double delta = 1.0;
  DeltaUnit unit = DeltaUnit::frames;
  double tolerance = 0.1;  ///< relative to delta [-]
};

/// Throws OptionError for a fractional number of frames or an angle beyond 180 degrees.
void check(const PairDelta& pair_delta);

/// Rule `all`: every i with one j by frames, seconds or metres (pair_search.hpp), or every j
/// rotated by delta within the tolerance for deg and rad (angle_pairs.hpp). Rule `consecutive`: see
/// consecutive.hpp; only seconds have a tolerance there. Seconds use reference stamps; metres and
/// angles are measured on `measured`. Throws as check does.
std::vector<FromTo> select_pairs(const Trajectory& reference,
                                 const Trajectory& measured,
                                 PairRule rule,
                                 const PairDelta& pair_delta);

/// Rotation from each pose to the one before it [rad]; 0 for the first.
std::vector<double> rotation_angles(const Trajectory& trajectory, AngleFormula formula);

}  // namespace loopbench::metrics
