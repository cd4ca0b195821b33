#include "metrics/correction/jumps.hpp"

#include <stdexcept>

#include "metrics/numerics/divided_differences.hpp"

namespace loopbench::metrics {
namespace {

struct Motion {
  Vector3 position = Vector3::Zero();      ///< [m]
  Vector3 velocity = Vector3::Zero();      ///< [m/s]
  Vector3 acceleration = Vector3::Zero();  ///< [m/s^2]
};

/// One-sided limit at `stamp` from four samples, relative to `origin` to keep precision.
Motion limit(double stamp, const Vector3& origin, const StampedPose* samples) {
  std::array<double, 4> offsets;
  std::array<Vector3, 4> points;
  for (std::size_t k = 0; k < 4; ++k) {
    offsets[k] = samples[k].stamp - stamp;
    points[k] = samples[k].world_from_body.translation - origin;
    if (offsets[k] == 0.0 || (k > 0 && offsets[k] == offsets[k - 1])) {
      throw std::runtime_error("jumps: the stamps around " + to_text(stamp) +
                               " s are too coarse for four samples next to a keyframe");
    }
  }
  const std::array<Vector3, 4> c = divided_differences(offsets, points);
  Motion out{c[3]};
  for (std::size_t k = 3; k-- > 0;) {  // Horner, with both derivatives, at offset 0
    out.acceleration = -offsets[k] * out.acceleration + 2.0 * out.velocity;
    out.velocity = -offsets[k] * out.velocity + out.position;
    out.position = -offsets[k] * out.position + c[k];
  }
  return out;
}

/// Four times before and four after each interior keyframe, sorted.
std::vector<double> times_beside(const Trajectory& keyframes, double reach) {
  std::vector<double> out;
  out.reserve(8 * (keyframes.size() - 2));
  for (std::size_t i = 1; i + 1 < keyframes.size(); ++i) {
    const double here = keyframes[i].stamp;
    const double before = 0.25 * reach * (here - keyframes[i - 1].stamp);
    const double after = 0.25 * reach * (keyframes[i + 1].stamp - here);
    for (int k = 4; k >= 1; --k) out.push_back(here - k * before);
    for (int k = 1; k <= 4; ++k) out.push_back(here + k * after);
  }
  return out;
}

}  // namespace

std::vector<Score> jumps(const Evaluation& evaluation, const JumpsOptions& options) {
  const Curve& curve = needed(evaluation.context.curve, "jumps", "a curve");
  const Trajectory& keyframes = needed(evaluation.context.estimate, "jumps", "keyframes");
  if (keyframes.size() < 3) throw Undefined("jumps: needs at least three keyframes");
  // One call, because evaluating a curve can have an O(n) setup cost.
  const Trajectory samples = curve.sample(times_beside(keyframes, options.reach));
  const double scale = evaluation.alignment.scale;
  std::vector<double> position;
  std::vector<double> velocity;
  std::vector<double> acceleration;
  for (std::size_t i = 1; i + 1 < keyframes.size(); ++i) {
    const auto& [stamp, pose] = keyframes[i];
    const StampedPose* beside = &samples[8 * (i - 1)];
    const Motion left = limit(stamp, pose.translation, beside);
    const Motion right = limit(stamp, pose.translation, beside + 4);
    position.push_back(scale * (right.position - left.position).norm());
    velocity.push_back(scale * (right.velocity - left.velocity).norm());
    acceleration.push_back(scale * (right.acceleration - left.acceleration).norm());
  }
  const int ddof = evaluation.protocol.ddof;
  return {{"position", "3d", "m", statistics(std::move(position), ddof)},
          {"velocity", "3d", "m/s", statistics(std::move(velocity), ddof)},
          {"acceleration", "3d", "m/s^2", statistics(std::move(acceleration), ddof)}};
}

}  // namespace loopbench::metrics
