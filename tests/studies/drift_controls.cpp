#include "tests/studies/drift_controls.hpp"

#include <Eigen/Cholesky>
#include <string>

#include "datasets/derive/poses_at.hpp"
#include "datasets/noise/random.hpp"
#include "datasets/simulated/simulated.hpp"

namespace loopbench {
namespace {

constexpr double kYaw = 2e-4, kPitch = 1e-4;  // [rad/m]

DevelopmentChain chain_of(const std::string& name, const SimulatedOptions& options) {
  Sequence sequence = load_simulated(options);
  DevelopmentChain out{name, name, name, std::move(sequence.problem), {}};
  out.problem.frames.clear();
  out.truth = poses_at(sequence.reference, stamps(out.problem.keyframes), {});
  return out;
}

/// Adds an error of about ten stated deviations to one edge in a hundred.
void add_slips(Problem& problem, Random& random) {
  Trajectory& keyframes = problem.keyframes;
  for (std::size_t i = 0; i < problem.odometry.size(); ++i) {
    Edge& edge = problem.odometry[i];
    if (random.uniform() < 0.01) {
      const Matrix6 deviations = edge.information.inverse().eval().llt().matrixL();
      const Twist error = 10.0 * deviations * twist(random.normal3(), random.normal3());
      edge.from_from_to = normalized(edge.from_from_to * exp_se3(error));
    }
    keyframes[i + 1].world_from_body = normalized(keyframes[i].world_from_body * edge.from_from_to);
  }
}

}  // namespace

std::vector<DriftControl> drift_controls(double gain) {
  constexpr int kSeeds = 50;
  std::vector<DriftControl> out;
  for (const std::int64_t closures : {3, 8}) {
    for (const std::string control : {"shared drift", "own drift", "no drift", "slips"}) {
      const std::string name = control + ", " + std::to_string(closures) + " closures";
      for (int seed = 1; seed <= kSeeds; ++seed) {
        Random random({seed}, Purpose::odometry);
        SimulatedOptions options;
        options.path = SimulatedPath::driving;
        options.seed = seed;
        options.stream = "drift controls";
        options.noise.gain = gain;
        options.closures.max = closures;
        const DevelopmentChain without = chain_of(name, options);
        const Vector3 drawn = random.normal3();
        const Vector3 rates = control == "shared drift" ? Vector3::Ones().eval()
                              : control == "own drift"  ? drawn
                                                        : Vector3::Zero().eval();
        options.drift.yaw_per_metre = kYaw * rates.x();
        options.drift.pitch_per_metre = kPitch * rates.y();
        out.push_back({chain_of(name, options), without});
        if (control != "slips") continue;
        add_slips(out.back().chain.problem, random);
        out.back().without_drift = out.back().chain;
      }
    }
  }
  return out;
}

}  // namespace loopbench
