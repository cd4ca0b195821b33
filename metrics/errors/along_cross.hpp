/// Position error along, across and above the direction of travel.
#pragma once

#include <cmath>

#include "metrics/metric.hpp"
#include "metrics/trajectory/heading.hpp"

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

inline constexpr double kUpright = 1e-3;  // sine between T and up below which `cross` is undefined

/// Unit direction of travel of each pose, kept while at rest; before the first move, the first.
inline std::vector<Vector3> directions(const Trajectory& reference, const AlongCrossOptions& o) {
  const std::vector<Chord> windows = chords(reference, o.window);
  std::vector<Vector3> out(windows.size());
  std::size_t known = 0;  // number of poses with a direction
  for (std::size_t i = 0; i < windows.size(); ++i) {
    if (!windows[i].is_moving(o.rest_speed)) {
      if (known > 0) out[known++] = out[i - 1];
      continue;
    }
    const Vector3 T = windows[i].displacement.normalized();
    while (known <= i) out[known++] = T;
  }
  if (known == 0) {
    throw Undefined("the reference never moves faster than " + to_text(o.rest_speed) +
                    " m/s, so it has no direction of travel");
  }
  return out;
}

inline Score magnitudes(const std::string& axis, std::vector<double> metres, int ddof) {
  if (!metres.empty()) return {"translation", axis, "m", statistics(std::move(metres), ddof)};
  return {"translation", axis, "m", {}, "the reference only moves parallel to `up`"};
}

/// translation [m], magnitudes. e is the position error. T is the reference's unit direction of
/// travel (chord over `window`), kept while the speed is below `rest_speed`. `along` |e.T| and
/// `off_track` |e - (e.T) T| do not depend on the orientation of the world frame, and their squares
/// add up to the squared 3-D error. `cross` and `vertical` split off_track: cross is horizontal
/// (up x T), vertical is T x cross. Both are undefined for poses where T is parallel to `up`, so
/// their count can be lower. (Frenet's normal and binormal are not used: they are undefined on
/// straight parts and flip at inflections.) Throws Undefined if the reference never moves. O(n).
inline std::vector<Score> along_cross(const Evaluation& evaluation,
                                      const AlongCrossOptions& options) {
  const std::vector<Vector3> heading = directions(evaluation.reference, options);
  const Vector3 up = Vector3::Unit(static_cast<int>(options.up));
  std::vector<double> along;
  std::vector<double> off_track;
  std::vector<double> cross;
  std::vector<double> vertical;
  for (std::size_t i = 0; i < heading.size(); ++i) {
    const Vector3& T = heading[i];
    const Vector3 e = evaluation.estimate[i].world_from_body.translation -
                      evaluation.reference[i].world_from_body.translation;
    along.push_back(std::abs(e.dot(T)));
    off_track.push_back((e - e.dot(T) * T).norm());
    const Vector3 beside = up.cross(T);
    if (beside.norm() < kUpright) continue;
    const Vector3 N = beside.normalized();
    cross.push_back(std::abs(e.dot(N)));
    vertical.push_back(std::abs(e.dot(T.cross(N))));
  }
  const int ddof = evaluation.protocol.ddof;
  return {magnitudes("along", std::move(along), ddof),
          magnitudes("off_track", std::move(off_track), ddof),
          magnitudes("cross", std::move(cross), ddof),
          magnitudes("vertical", std::move(vertical), ddof)};
}

}  // namespace loopbench::metrics
