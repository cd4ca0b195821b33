#include "tests/studies/pose_faults.hpp"

#include <algorithm>
#include <cmath>

#include "datasets/core/median_interval.hpp"
#include "datasets/core/se3.hpp"
#include "metrics/doctor/agreement.hpp"

namespace loopbench {
namespace {

using Others = std::vector<Recording>;

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

bool flip(std::mt19937& random) { return uniform(random, 0.0, 1.0) < 0.5; }

/// A pose in either file or in the estimate is replaced by `change`.
template <class Change>
bool change_poses(Trajectory& poses, Change change) {
  for (auto& [stamp, pose] : poses) pose = change(pose);
  return true;
}

Trajectory& either(Recording& r, std::mt19937& random) {
  return flip(random) ? r.reference : r.estimate;
}

bool has_regular_stamps(const Recording& r) {
  if (!r.has_stamps || r.estimate.size() < 100) return false;
  const double usual = median_interval(r.estimate);
  const auto is_usual = [&](std::size_t i) {
    return std::abs(r.estimate[i].stamp - r.estimate[i - 1].stamp - usual) < 0.2 * usual;
  };
  std::size_t count = 0;
  for (std::size_t i = 1; i < r.estimate.size(); ++i) count += is_usual(i) ? 1 : 0;
  return count > 4 * r.estimate.size() / 5 && usual < 0.15;
}

std::vector<PlantedFault> units() {
  const auto length = [](double factor) {
    return [=](Recording& r, std::mt19937& random, const Others&) {
      if (is_monocular(r)) return false;  // any scale is right
      return change_poses(either(r, random), [=](const Pose& p) -> Pose {
        return {p.rotation, factor * p.translation};
      });
    };
  };
  return {{"millimetres", {"scale"}, length(1000.0)},
          {"centimetres", {"scale"}, length(100.0)},
          {"no metric scale", {"scale"}, [](Recording& r, std::mt19937& random, const Others&) {
             if (is_monocular(r)) return false;
             const double factor =
                 flip(random) ? uniform(random, 0.25, 0.75) : uniform(random, 1.4, 4.0);
             return change_poses(r.estimate, [=](const Pose& p) -> Pose {
               return {p.rotation, factor * p.translation};
             });
           }}};
}

std::vector<PlantedFault> frames() {
  const auto in_either = [](Pose (*change)(const Pose&)) {
    return [=](Recording& r, std::mt19937& random, const Others&) {
      return change_poses(either(r, random), change);
    };
  };
  return {
      {"quaternions w x y z", {"quaternion_order"}, in_either([](const Pose& p) -> Pose {
         const Rotation& q = p.rotation;
         return {Rotation(q.z(), q.w(), q.x(), q.y()), p.translation};
       })},
      {"inverted rotations", {"inverted_poses"}, in_either([](const Pose& p) -> Pose {
         return {p.rotation.conjugate(), p.translation};
       })},
      {"inverted poses", {"inverted_poses"}, in_either([](const Pose& p) { return p.inverse(); })},
      {"a mirrored axis",
       {"mirrored"},
       [](Recording& r, std::mt19937& random, const Others&) {
         const int axis = r.is_car ? 0 : static_cast<int>(uniform(random, 0.0, 3.0));
         return change_poses(r.estimate, [=](Pose p) {
           p.translation[axis] = -p.translation[axis];
           return p;
         });
       }},
      {"two axes exchanged",
       {"mirrored"},
       [](Recording& r, std::mt19937& random, const Others&) {
         const int a = static_cast<int>(uniform(random, 0.0, 3.0));
         return change_poses(r.estimate, [=](Pose p) {
           std::swap(p.translation[a], p.translation[(a + 1) % 3]);
           return p;
         });
       }},
      {"axes y z x",
       {"axes"},
       [](Recording& r, std::mt19937&, const Others&) {
         return change_poses(r.estimate, [](const Pose& p) -> Pose {
           return {p.rotation, {p.translation.y(), p.translation.z(), p.translation.x()}};
         });
       }},
      {"axes of a camera",
       {"other_body"},
       [](Recording& r, std::mt19937& random, const Others&) {
         Rotation camera(0.5, -0.5, 0.5, -0.5);
         if (flip(random)) camera = camera.conjugate();
         return change_poses(either(r, random), [=](const Pose& p) -> Pose {
           return {p.rotation * camera, p.translation};
         });
       }},
      {"a rotated body",
       {"other_body"},
       [](Recording& r, std::mt19937& random, const Others&) {
         const Vector3 axis(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
         const Rotation body = exp_so3(uniform(random, 0.5, 3.1) * axis.normalized());
         return change_poses(r.estimate, [=](const Pose& p) -> Pose {
           return {p.rotation * body, p.translation};
         });
       }},
      {"another body",
       {"other_body"},
       [](Recording& r, std::mt19937& random, const Others&) {
         const double length = r.is_car ? uniform(random, 1.5, 3.0) : uniform(random, 0.4, 0.8);
         Vector3 arm(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
         if (r.is_car) arm = {0.3, -0.2, 0.25};  // not along the height or a straight road
         const Pose other{Rotation::Identity(), length * arm.normalized()};
         return change_poses(r.estimate, [=](const Pose& p) { return p * other; });
       },
       true}};
}

bool delay(Recording& r, double seconds) {
  for (StampedPose& pose : r.estimate) pose.stamp += seconds;
  return r.has_stamps;
}

std::vector<PlantedFault> times() {
  return {
      {"a time offset",
       {"time_offset"},
       [](Recording& r, std::mt19937& random, const Others&) {
         return delay(r, (flip(random) ? 1.0 : -1.0) * uniform(random, 0.15, 3.0));
       }},
      {"clocks without overlap",
       {"time_offset", "no_overlap"},
       [](Recording& r, std::mt19937& random, const Others&) {
         return delay(r, uniform(random, 1e4, 1e6));
       }},
      {"shifted rows",
       {"time_offset"},
       [](Recording& r, std::mt19937& random, const Others&) {
         if (r.has_stamps || r.reference.size() != r.estimate.size()) return false;
         const auto rows = static_cast<std::size_t>(uniform(random, 1.0, 4.0));
         for (std::size_t i = 0; i + rows < r.estimate.size(); ++i)
           r.estimate[i].world_from_body = r.estimate[i + rows].world_from_body;
         r.estimate.resize(r.estimate.size() - rows);
         r.reference.resize(r.estimate.size());
         return true;
       }},
      {"half a frame",
       {"time_offset"},
       [](Recording& r, std::mt19937& random, const Others&) {
         constexpr double kLeast = 0.02;  // [s]; smaller offsets are not reported
         const double half = 0.5 * median_interval(r.estimate);
         return has_regular_stamps(r) && half > kLeast && delay(r, flip(random) ? half : -half);
       },
       true},
      {"stamps in another unit",
       {"stamp_unit"},
       [](Recording& r, std::mt19937& random, const Others&) {
         const double factor = std::pow(1000.0, std::floor(uniform(random, 1.0, 4.0)));
         for (StampedPose& pose : either(r, random)) pose.stamp *= factor;
         return r.has_stamps;
       }},
      {"frame indices as stamps", {"no_overlap"}, [](Recording& r, std::mt19937&, const Others&) {
         if (!has_regular_stamps(r)) return false;
         const double start = r.estimate.front().stamp, usual = median_interval(r.estimate);
         for (StampedPose& p : r.estimate) p.stamp = std::round((p.stamp - start) / usual);
         const auto same = [](const StampedPose& a, const StampedPose& b) {
           return a.stamp == b.stamp;
         };
         r.estimate.erase(std::unique(r.estimate.begin(), r.estimate.end(), same),
                          r.estimate.end());
         return true;
       }}};
}

Trajectory without_rotations(Trajectory poses) {
  for (StampedPose& pose : poses) pose.world_from_body.rotation = Rotation::Identity();
  return poses;
}

std::vector<PlantedFault> files() {
  return {
      {"files exchanged",
       {"swapped"},
       [](Recording& r, std::mt19937&, const Others&) {
         std::swap(r.reference, r.estimate);
         std::swap(r.reference_name, r.estimate_name);
         return true;
       }},
      {"another recording",
       {"wrong_recording"},
       [](Recording& r, std::mt19937& random, const Others& others) {
         const Recording& other = others[random() % others.size()];
         const bool is_same = other.reference_name == r.reference_name;
         if (is_same || other.has_stamps != r.has_stamps || other.is_car != r.is_car) return false;
         if (r.reference_name.find("simulated") == 0) return false;
         const auto& a = r.reference;
         const auto& b = other.reference;
         const bool is_same_time =
             a.front().stamp < b.back().stamp && b.front().stamp < a.back().stamp;
         if (r.has_stamps && is_same_time) return false;
         const double shift = r.estimate.front().stamp - other.reference.front().stamp;
         r.reference = other.reference;
         for (StampedPose& pose : r.reference) pose.stamp += shift;
         return true;
       }},
      {"another recording, another day",
       {"no_overlap", "wrong_recording"},
       [](Recording& r, std::mt19937& random, const Others& others) {
         const Recording& other = others[random() % others.size()];
         if (other.reference_name == r.reference_name || !other.has_stamps || !r.has_stamps) {
           return false;
         }
         r.reference = other.reference;
         return r.reference.front().stamp > r.estimate.back().stamp ||
                r.reference.back().stamp < r.estimate.front().stamp;
       }},
      {"a file without rotations",
       {"constant_rotation"},
       [](Recording& r, std::mt19937& random, const Others&) {
         Trajectory& poses = either(r, random);
         poses = without_rotations(poses);
         return true;
       }},
      {"a jump",
       {"jumps"},
       [](Recording& r, std::mt19937& random, const Others&) {
         const auto at = static_cast<std::size_t>(uniform(random, 0.2, 0.8) *
                                                  static_cast<double>(r.estimate.size()));
         Vector3 size(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
         size =
             (r.is_car ? uniform(random, 10, 40) : uniform(random, 0.5, 2.0)) * size.normalized();
         if (is_monocular(r)) return false;
         for (std::size_t i = at; i < r.estimate.size(); ++i) {
           r.estimate[i].world_from_body.translation += size;
         }
         return true;
       }},
      {"30 % missing", {"missing_poses"}, [](Recording& r, std::mt19937& random, const Others&) {
         const auto n = static_cast<double>(r.estimate.size());
         const auto begin = static_cast<std::ptrdiff_t>(uniform(random, 0.0, 0.7) * n);
         r.estimate.erase(r.estimate.begin() + begin,
                          r.estimate.begin() + begin + static_cast<std::ptrdiff_t>(0.3 * n));
         return r.has_stamps;
       }}};
}

}  // namespace

bool exceeds_errors(const Recording& right, const Recording& planted) {
  const metrics::Agreement errors =
      metrics::agreement(metrics::common_poses(right.reference, right.estimate));
  const metrics::Agreement change =
      metrics::agreement(metrics::common_poses(right.estimate, planted.estimate));
  return change.displacement > errors.displacement || change.usual_turning > errors.usual_turning;
}

std::vector<PlantedFault> pose_faults() {
  std::vector<PlantedFault> out;
  for (const auto& group : {units(), frames(), times(), files()}) {
    out.insert(out.end(), group.begin(), group.end());
  }
  return out;
}

}  // namespace loopbench
