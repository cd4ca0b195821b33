#include "datasets/rgbd/tracking/observations.hpp"

namespace loopbench::rgbd {

std::vector<Observation> observations(const std::vector<MapPoint>& points,
                                      const Features& features,
                                      const std::vector<Match>& matches) {
  std::vector<Observation> out;
  out.reserve(matches.size());
  for (const Match& match : matches) {
    const Feature& f = features.points[match.b];
    const double depth = static_cast<double>(f.depth);
    out.push_back({points[match.a].in_world,
                   static_cast<double>(f.u),
                   static_cast<double>(f.v),
                   depth > 0.0 ? 1.0 / depth : 0.0,
                   static_cast<double>(f.sigma)});
  }
  return out;
}

}  // namespace loopbench::rgbd
