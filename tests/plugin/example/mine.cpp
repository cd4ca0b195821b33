#include <loopbench/datasets/core/interpolate.hpp>
#include <loopbench/plugin.hpp>

using namespace loopbench;

Trajectory half_way(const Problem& problem) {
  Trajectory out = problem.keyframes;
  for (const Edge& loop : problem.closures) {
    Pose& end = out[loop.to].world_from_body;
    end = interpolate(end, out[loop.from].world_from_body * loop.from_from_to, 0.5);
  }
  return out;
}

LOOPBENCH_PLUGIN(method("half_way", "moves the last keyframe of each loop half way", half_way))
