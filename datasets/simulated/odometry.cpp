#include "datasets/simulated/odometry.hpp"

#include <Eigen/LU>

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

Matrix6 isotropic(double sigma_t, double sigma_r) {
  Matrix6 out = Matrix6::Zero();
  out.diagonal().head<3>().setConstant(sigma_t * sigma_t);
  out.diagonal().tail<3>().setConstant(sigma_r * sigma_r);
  return out;
}

Matrix6 inverted(const Matrix6& covariance) {
  const Matrix6 inverse = covariance.inverse();
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
    const Twist error = mask.cwiseProduct(random.normal_twist(sigma_t, sigma_r));
    const Twist bias = mask.cwiseProduct(drift_of(options.drift, before_from_after, step));
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

}  // namespace loopbench
