#include "datasets/simulated/edges.hpp"

#include <algorithm>
#include <initializer_list>
#include <numeric>
#include <tuple>
#include <utility>

#include "datasets/core/factorisations.hpp"
#include "datasets/noise/random.hpp"

namespace loopbench {
namespace {

/// Magnitude of one step, on which its errors depend.
struct Motion {
  double seconds;
  double metres;
  double radians;
};

double sigma(const StepVariance& variance, double gain, const Motion& step) {
  const double speed = step.metres / step.seconds;
  return gain * std::sqrt(variance.per_second * step.seconds + variance.per_metre * step.metres +
                          variance.per_radian * step.radians +
                          variance.per_speed * speed * speed * step.seconds);
}

/// Systematic error of a step, as right perturbation.
Twist drift_of(const SystematicDrift& drift, const Pose& before_from_after, const Motion& step) {
  const double pitch = drift.pitch_per_second * step.seconds + drift.pitch_per_metre * step.metres +
                       drift.pitch_per_radian * step.radians;
  const double yaw = drift.yaw_per_second * step.seconds + drift.yaw_per_metre * step.metres +
                     drift.yaw_per_radian * step.radians;
  const Vector3 step_in_after =
      before_from_after.rotation.conjugate() * before_from_after.translation;
  return twist(drift.scale * step_in_after, Vector3(0.0, pitch, yaw));
}

/// Removes rotations that are not about the vertical from twists of the body.
void keep_yaw(const Pose& world_from_body, std::initializer_list<Twist*> twists) {
  const Vector3 up = world_from_body.rotation.conjugate() * Vector3::UnitZ();
  for (Twist* const each : twists) each->tail<3>() = up * up.dot(each->tail<3>());
}

Matrix6 isotropic(double sigma_t, double sigma_r) {
  Matrix6 out = Matrix6::Zero();
  out.diagonal().head<3>().setConstant(sigma_t * sigma_t);
  out.diagonal().tail<3>().setConstant(sigma_r * sigma_r);
  return out;
}

Matrix6 inverted(const Matrix6& covariance) {
  const Matrix6 inverse = inverse_of(covariance);
  return 0.5 * (inverse + inverse.transpose());
}

}  // namespace

Odometry simulate_odometry(const Trajectory& truth,
                           const std::vector<std::size_t>& keyframes,
                           const SimulatedOptions& options) {
  const OdometryNoise& noise = options.noise;
  Random random(noise_stream(options), Purpose::odometry);
  const Twist mask = options.planar ? twist({1.0, 1.0, 0.0}, {0.0, 0.0, 1.0}) : Twist::Ones();

  Odometry out;
  out.frames.reserve(truth.size());
  out.frames.push_back(truth.front());
  out.edges.reserve(keyframes.size() - 1);
  std::size_t from = 0;  // keyframe at the start of the current edge
  Pose edge;
  Matrix6 covariance = isotropic(kSigmaFloor, kSigmaFloor);
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const Pose before_from_after =
        truth[i - 1].world_from_body.inverse() * truth[i].world_from_body;
    const Motion step{truth[i].stamp - truth[i - 1].stamp,
                      before_from_after.translation.norm(),
                      log_so3(before_from_after.rotation).norm()};
    const double sigma_t = sigma(noise.translation, noise.gain, step);
    const double sigma_r = sigma(noise.rotation, noise.gain, step);
    Twist error = mask.cwiseProduct(random.normal_twist(sigma_t, sigma_r));
    Twist bias = mask.cwiseProduct(drift_of(options.drift, before_from_after, step));
    if (noise.level) keep_yaw(truth[i].world_from_body, {&bias, &error});
    const Pose measured = before_from_after * exp_se3(bias) * exp_se3(error);

    const Pose& before = out.frames.back().world_from_body;
    out.frames.push_back({truth[i].stamp, normalized(before * measured)});
    edge = normalized(edge * measured);
    const Matrix6 after_from_before = adjoint(before_from_after.inverse());
    covariance = after_from_before * covariance * after_from_before.transpose() +
                 isotropic(sigma_t, sigma_r);
    if (from + 1 < keyframes.size() && keyframes[from + 1] == i) {
      out.edges.push_back({from, from + 1, edge, inverted(covariance)});
      ++from;
      edge = Pose{};
      covariance = isotropic(kSigmaFloor, kSigmaFloor);
    }
  }
  return out;
}

namespace {

constexpr int kMaxAttempts = 1000;  // rejected pairs after which a path counts as stationary

/// Subsamples `count` pairs evenly by index, always including the last one.
std::vector<Revisit> subsampled(const std::vector<Revisit>& pairs, std::size_t count) {
  if (pairs.size() <= count) return pairs;
  std::vector<Revisit> out;
  for (std::size_t k = 1; k <= count; ++k) out.push_back(pairs[k * pairs.size() / count - 1]);
  return out;
}

Matrix6 information(const SimulatedClosures& options) {
  const double sigma_t = std::max(options.sigma_t, kSigmaFloor);
  const double sigma_r = std::max(options.sigma_r, kSigmaFloor);
  Matrix6 out = Matrix6::Zero();
  out.diagonal().head<3>().setConstant(1.0 / (sigma_t * sigma_t));
  out.diagonal().tail<3>().setConstant(1.0 / (sigma_r * sigma_r));
  return out;
}

/// Draws a pair of keyframes at different places, at least min_gap apart in time.
std::pair<std::size_t, std::size_t> unrelated_pair(const Trajectory& truth,
                                                   const RevisitRule& same,
                                                   Random& random) {
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    auto [from, to] = std::minmax({random.index(truth.size()), random.index(truth.size())});
    if (truth[to].stamp - truth[from].stamp < same.min_gap) continue;
    const Pose& earlier = truth[from].world_from_body;
    const Pose& later = truth[to].world_from_body;
    if (is_close(earlier, later, 2.0 * same.radius, 2.0 * same.angle)) continue;
    return {from, to};
  }
  throw OptionError(
      "closures.false_share",
      "closures.false_share: found no two different places, expected a path that moves "
      "and is longer than closures.min_gap");
}

}  // namespace

SimulatedLoops simulate_closures(const Trajectory& truth,
                                 const RevisitRule& same,
                                 const SimulatedOptions& options) {
  const SimulatedClosures& closures = options.closures;
  const Twist mask = options.planar ? twist({1.0, 1.0, 0.0}, {0.0, 0.0, 1.0}) : Twist::Ones();
  std::vector<std::pair<Edge, bool>> drawn;  // and whether it is false

  Random noise(noise_stream(options), Purpose::closures);
  const std::vector<Revisit> pairs =
      subsampled(find_revisits(truth, same), static_cast<std::size_t>(closures.max));
  for (const auto& [from, to] : pairs) {
    const Pose exact = truth[from].world_from_body.inverse() * truth[to].world_from_body;
    const Twist error = mask.cwiseProduct(noise.normal_twist(closures.sigma_t, closures.sigma_r));
    drawn.push_back({{from, to, exact * exp_se3(error), information(closures)}, false});
  }

  const double share = closures.false_share;
  const auto false_count = static_cast<std::size_t>(
      std::llround(static_cast<double>(pairs.size()) * share / (1.0 - share)));
  Random false_noise(noise_stream(options), Purpose::false_closures);
  for (std::size_t k = 0; k < false_count; ++k) {
    const auto [from, to] = unrelated_pair(truth, same, false_noise);
    // A false measurement has the same size as the relative pose of a true revisit.
    const Twist measured =
        mask.cwiseProduct(false_noise.normal_twist(0.5 * same.radius, 0.5 * same.angle));
    drawn.push_back({{from, to, exp_se3(measured), information(closures)}, true});
  }
  std::sort(drawn.begin(), drawn.end(), [](const auto& a, const auto& b) {
    return std::tie(a.first.to, a.first.from) < std::tie(b.first.to, b.first.from);
  });
  SimulatedLoops out;
  for (const auto& [edge, is_false] : drawn) {
    if (is_false) out.false_ones.push_back(out.closures.size());
    out.closures.push_back(edge);
  }
  return out;
}

std::vector<Anchor> simulate_anchors(const Trajectory& truth, const SimulatedOptions& options) {
  const auto count = static_cast<std::size_t>(options.anchors.count);
  if (count > truth.size()) {
    throw OptionError("anchors.count",
                      "anchors.count = " + std::to_string(count) + ": expected at most " +
                          std::to_string(truth.size()) + ", the number of keyframes");
  }
  const Vector3 mask(1.0, 1.0, options.planar ? 0.0 : 1.0);
  const double sigma = options.anchors.sigma;
  const double stated = std::max(sigma, kSigmaFloor);
  Random random(noise_stream(options), Purpose::anchors);
  std::vector<std::size_t> keyframes(truth.size());
  std::iota(keyframes.begin(), keyframes.end(), std::size_t{0});
  std::vector<Anchor> out;
  for (std::size_t k = 0; k < count; ++k) {
    std::swap(keyframes[k], keyframes[k + random.index(keyframes.size() - k)]);
    const Vector3 error = sigma * mask.cwiseProduct(random.normal3());
    out.push_back({keyframes[k],
                   truth[keyframes[k]].world_from_body.translation + error,
                   stated * stated * Matrix3::Identity()});
  }
  std::ranges::sort(out, {}, &Anchor::keyframe);
  return out;
}

}  // namespace loopbench
