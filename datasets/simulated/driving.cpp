// Path of straight streets, 90 degree corners and stops. Within a piece the distance travelled is a
// cubic polynomial of time that matches the speeds at both ends.
#include <algorithm>
#include <memory>
#include <numbers>
#include <vector>

#include "datasets/simulated/path.hpp"

namespace loopbench {
namespace {

constexpr double kRadius = 8.0;       // radius of a corner [m]
constexpr double kCornerSpeed = 4.0;  // [m/s]; lateral acceleration 2 m/s^2
constexpr double kFromStop = 2.5;     // mean speed in a corner after a stop [m/s]

struct Leg {
  double street;  // length from crossing to crossing or to the end of the lap [m]
  double speed;   // mean speed on the straight [m/s]
  double red;     // duration of the stop before the corner [s]; 0: no stop
  int turn;       // +1 left, -1 right, 0 end of the lap
};

// Streets lie on a grid of 100 m x 80 m. The lap starts and ends in the middle of the first street.
// The second half of the first street and the second street are driven twice (legs 5 and 6 repeat 1
// and 2), leg 8 passes the crossing at the end of leg 3, leg 11 ends at the start.
constexpr Leg kRoute[] = {{160, 11, 0, +1},
                          {80, 6, 4, +1},
                          {100, 7, 0, +1},
                          {80, 5, 6, +1},
                          {100, 6, 0, +1},
                          {160, 10, 3, +1},
                          {100, 7, 0, +1},
                          {80, 6, 8, -1},
                          {100, 7, 0, +1},
                          {80, 6, 0, +1},
                          {40, 4, 2, 0}};

struct Piece {
  double begin, duration;  // [s]
  double length;           // [m]
  double entry, exit;      // speeds [m/s]
  double x, y, yaw;        // pose at the start
  double curvature;        // [1/m], positive to the left

  /// Distance travelled [m].
  double distance_at(double time) const {
    const double u = (time - begin) / duration;
    return length * u * u * (3.0 - 2.0 * u) + duration * entry * u * (1.0 - u) * (1.0 - u) -
           duration * exit * u * u * (1.0 - u);
  }

  /// x, y [m] and yaw [rad] after `s` metres.
  Vector3 pose_after(double s) const {
    const double half = 0.5 * curvature * s;
    const double chord = half == 0.0 ? s : s * std::sin(half) / half;
    return {x + chord * std::cos(yaw + half), y + chord * std::sin(yaw + half), yaw + 2.0 * half};
  }
};

class Route {
 public:
  Route() {
    double speed = 0.0;
    double in_corner = 0.0;  // part of the street that belongs to the previous corner [m]
    for (const auto& [street, mean, red, turn] : kRoute) {
      const double straight = street - in_corner - (turn == 0 ? 0.0 : kRadius);
      const double end_speed = red > 0.0 ? 0.0 : kCornerSpeed;
      add(straight, straight / mean, speed, end_speed, 0.0);
      if (red > 0.0) add(0.0, red, 0.0, 0.0, 0.0);
      if (turn != 0) {
        const double arc = 0.5 * std::numbers::pi * kRadius;
        add(arc,
            arc / (red > 0.0 ? kFromStop : kCornerSpeed),
            end_speed,
            kCornerSpeed,
            turn / kRadius);
      }
      speed = turn == 0 ? end_speed : kCornerSpeed;
      in_corner = kRadius;
    }
  }

  double duration() const { return pieces_.back().begin + pieces_.back().duration; }

  Pose at(double time) const {
    const double in_lap = std::fmod(time, duration());
    const auto above = std::upper_bound(
        pieces_.begin(), pieces_.end(), in_lap, [](double value, const Piece& piece) {
          return value < piece.begin;
        });
    const Piece& piece = *std::prev(above);
    const Vector3 planar = piece.pose_after(piece.distance_at(in_lap));
    return on_ground(planar.x(), planar.y(), planar.z());
  }

 private:
  void add(double length, double duration, double entry, double exit, double curvature) {
    Piece next{0.0, duration, length, entry, exit, 0.0, 0.0, 0.0, curvature};
    if (!pieces_.empty()) {
      const Piece& last = pieces_.back();
      const Vector3 end = last.pose_after(last.length);
      next.begin = last.begin + last.duration;
      next.x = end.x();
      next.y = end.y();
      next.yaw = end.z();
    }
    pieces_.push_back(next);
  }

  /// Lifts a planar pose onto smooth hills. Height depends on the position only, so that a street
  /// has the same height in every pass.
  static Pose on_ground(double x, double y, double yaw) {
    const double z = 0.6 * std::sin(0.03 * x) + 0.5 * std::sin(0.025 * y);
    const double slope_x = 0.018 * std::cos(0.03 * x);
    const double slope_y = 0.0125 * std::cos(0.025 * y);
    const double ahead = slope_x * std::cos(yaw) + slope_y * std::sin(yaw);
    const double left = slope_y * std::cos(yaw) - slope_x * std::sin(yaw);
    return {rotation_from_yaw_pitch_roll(yaw, -std::atan(ahead), std::atan(left)), {x, y, z}};
  }

  std::vector<Piece> pieces_;
};

}  // namespace

Path driving_path() {
  const auto route = std::make_shared<const Route>();
  return {route->duration(), 400, 10.0, 4.0, [route](double time) { return route->at(time); }};
}

}  // namespace loopbench
