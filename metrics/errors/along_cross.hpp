/// Position error along, across and above the direction of travel.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

/// Which axis of the reference's world points up (or down).
enum class UpAxis { x, y, z };
inline auto choices(UpAxis) {
  return std::array{
      std::pair{"x", UpAxis::x}, std::pair{"y", UpAxis::y}, std::pair{"z", UpAxis::z}};
}

struct AlongCrossOptions {
  UpAxis up = UpAxis::z;
  double window = 1.0;
  double rest_speed = 0.05;
};

template <class Visit>
void fields(AlongCrossOptions& o, Visit visit) {
  visit("up", o.up, "vertical axis of the reference's world; y for camera frames");
  visit("window", o.window, "time window for the direction of travel [s]", Between{0.0});
  visit("rest_speed",
        o.rest_speed,
        "speed below which the last direction of travel is kept [m/s]",
        Between{0.0});
}

/// translation [m], magnitudes. e is the position error. T is the reference's unit direction of
/// travel (chord over `window`), kept while the speed is below `rest_speed`. `along` |e.T| and
/// `off_track` |e - (e.T) T| do not depend on the orientation of the world frame, and their squares
/// add up to the squared 3-D error. `cross` and `vertical` split off_track: cross is horizontal
/// (up x T), vertical is T x cross. Both are undefined for poses where T is parallel to `up`, so
/// their count can be lower. (Frenet's normal and binormal are not used: they are undefined on
/// straight parts and flip at inflections.) Throws Undefined if the reference never moves. O(n).
std::vector<Score> along_cross(const Evaluation& evaluation, const AlongCrossOptions& options);

}  // namespace loopbench::metrics
