#include "metrics/losses.hpp"

#include <algorithm>

namespace loopbench {

std::vector<Loss> losses(const Trajectory& reference,
                         const Trajectory& estimate,
                         double offset,
                         double longest_pause,
                         double standing) {
  std::vector<Loss> out;
  std::size_t first = 0;  // first reference pose inside the pause
  for (std::size_t i = 1; i < estimate.size(); ++i) {
    const Loss pause{estimate[i - 1].stamp + offset, estimate[i].stamp + offset};
    const double duration = pause.end - pause.begin;
    if (!(duration > longest_pause)) continue;
    while (first < reference.size() && reference[first].stamp < pause.begin) ++first;
    double farthest = 0.0;
    bool is_seen = false;
    for (std::size_t k = first; k < reference.size() && reference[k].stamp <= pause.end; ++k) {
      is_seen |= reference[k].stamp > pause.begin && reference[k].stamp < pause.end;
      const Vector3 way =
          reference[k].world_from_body.translation - reference[first].world_from_body.translation;
      farthest = std::max(farthest, way.norm());
    }
    if (is_seen && farthest > standing * duration) out.push_back(pause);
  }
  return out;
}

}  // namespace loopbench
