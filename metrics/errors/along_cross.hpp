/// Position error as a traveller sees it: ahead or behind, beside, above.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench {

/// Which axis of the reference's world points up (or down).
enum class Up { x, y, z };
inline auto choices(Up) {
  return std::array{std::pair{"x", Up::x}, std::pair{"y", Up::y}, std::pair{"z", Up::z}};
}

struct AlongCrossOptions {
  Up up = Up::z;
  double window = 1.0;
  double standing = 0.05;
};

template <class Visit>
void fields(AlongCrossOptions& o, Visit visit) {
  visit("up", o.up, "axis of the reference's world that is vertical; y for cameras");
  visit("window", o.window, "time over which the direction of travel is taken [s]", Between{0.0});
  visit("standing", o.standing, "below this speed the last direction is kept [m/s]", Between{0.0});
}

/// translation [m], magnitudes. T is the reference's direction of travel (chord over `window`),
/// kept while standing. `along` |e.T| and `off_track` |e - (e.T) T| do not depend on how the world
/// is turned and their squares add up to the 3-D ones. `cross` and `vertical` split off_track:
/// cross is horizontal (up x T), vertical is T x cross; poses where T points up or down have
/// neither and their count is lower. (Frenet's normal and binormal are not used: undefined on
/// straight parts and flipping at inflections.) Throws Undefined when the reference never
/// moves. O(n).
std::vector<Score> along_cross(const Evaluation& evaluation, const AlongCrossOptions& options);

}  // namespace loopbench
