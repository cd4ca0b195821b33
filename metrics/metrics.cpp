#include "metrics/ape.hpp"
#include "metrics/ate.hpp"
#include "metrics/axis_error.hpp"
#include "metrics/coverage.hpp"
#include "metrics/metric.hpp"
#include "metrics/rpe.hpp"
#include "metrics/segments/segments.hpp"

namespace loopbench {

std::vector<MetricEntry> metrics() {
  return {
      metric<AteOptions>("ate", "distance and angle of each pose from its reference", ate),
      metric<AxisErrorOptions>("axis_error", "position error along x, y and z", axis_error),
      metric<ApeOptions>("ape", "absolute error in one of evo's pose relations", ape),
      metric<RpeOptions>("rpe", "error of the motion over frames, seconds, metres or turns", rpe),
      metric<SegmentsOptions>("segments", "drift over sub-trajectories of given lengths", segments),
      metric<CoverageOptions>("coverage", "how much of the trajectory was judged", coverage),
  };
}

}  // namespace loopbench
