#include "datasets/simulated/simulated.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "datasets/random.hpp"
#include "datasets/simulated/closures.hpp"
#include "datasets/simulated/odometry.hpp"
#include "datasets/simulated/path.hpp"
#include "datasets/simulated/sampled.hpp"

namespace loopbench {
namespace {

/// Default ratio of reference rate and frame rate. With a power of two, k / frame_rate and
/// 4 k / (4 frame_rate) are bit-identical and every frame has a reference pose at its stamp.
constexpr std::size_t kReferencePerFrame = 4;

struct Sampling {
  double seconds = 0.0;
  double frame_rate = 0.0;      // [Hz]
  double reference_rate = 0.0;  // [Hz]
};

Sampling sampling_of(const SimulatedOptions& options, const Path& path) {
  Sampling out;
  out.seconds = path.duration * static_cast<double>(options.laps);
  out.frame_rate = options.frame_rate > 0.0 ? options.frame_rate : path.frame_rate;
  out.reference_rate = options.reference_rate == 0.0
                           ? static_cast<double>(kReferencePerFrame) * out.frame_rate
                           : options.reference_rate;
  return out;
}

Trajectory frames_of(const Trajectory& reference) {
  Trajectory out;
  out.reserve(reference.size() / kReferencePerFrame + 1);
  for (std::size_t i = 0; i < reference.size(); i += kReferencePerFrame)
    out.push_back(reference[i]);
  return out;
}

/// Returns `count` evenly spaced indices from 0 to size - 1. Throws OptionError if count > size.
std::vector<std::size_t> even_indices(std::size_t count, std::size_t size) {
  if (count > size) {
    throw OptionError(
        "keyframes",
        fmt::format("keyframes = {}: expected keyframes <= {}, the number of frames", count, size));
  }
  std::vector<std::size_t> out(count, 0);
  for (std::size_t k = 1; k < count; ++k) {
    out[k] = (2 * k * (size - 1) + (count - 1)) / (2 * (count - 1));  // rounded to nearest
  }
  return out;
}

Trajectory at(const std::vector<std::size_t>& indices, const Trajectory& poses) {
  Trajectory out;
  out.reserve(indices.size());
  for (const std::size_t index : indices) out.push_back(poses[index]);
  return out;
}

/// Adds independent noise to each pose, in x, y and yaw only if `planar`.
void add_white_noise(Trajectory& poses, const SimulatedOptions& options) {
  const auto [sigma_t, sigma_r] = options.white_noise;
  if (sigma_t == 0.0 && sigma_r == 0.0) return;
  const Twist mask = options.planar ? twist({1.0, 1.0, 0.0}, {0.0, 0.0, 1.0}) : Twist::Ones();
  Random random(noise_stream(options), Purpose::white_noise);
  for (auto& [stamp, pose] : poses) {
    const Twist noise = mask.cwiseProduct(random.normal_twist(sigma_t, sigma_r));
    pose = normalized(pose * exp_se3(noise));
  }
}

}  // namespace

Sequence load_simulated(const SimulatedOptions& options, const DataRoot&) {
  check_combination(options);
  const Path path = path_of(options.path);
  const Sampling sampling = sampling_of(options, path);
  const bool default_rate = options.reference_rate == 0.0;
  const std::int64_t keyframe_count =
      options.keyframes > 0 ? options.keyframes : path.keyframes * options.laps;

  Trajectory reference =
      sampled(options.path, sampling.reference_rate, sampling.seconds, options.planar);
  const Trajectory truth =
      default_rate ? frames_of(reference)
                   : sampled(options.path, sampling.frame_rate, sampling.seconds, options.planar);
  const std::vector<std::size_t> keyframes =
      even_indices(static_cast<std::size_t>(keyframe_count), truth.size());
  Odometry odometry = simulate_odometry(truth, keyframes, options);
  add_white_noise(odometry.frames, options);
  const SimulatedClosures& closures = options.closures;
  const RevisitRule same{closures.radius > 0.0 ? closures.radius : path.closure_radius,
                         closures.angle * std::numbers::pi / 180.0,
                         closures.min_gap};

  Sequence out;
  out.name = "simulated_" + to_text(options.path);
  out.problem.keyframes = at(keyframes, odometry.frames);
  out.problem.odometry = std::move(odometry.edges);
  out.problem.closures = simulate_closures(at(keyframes, truth), same, options);
  out.problem.frames = std::move(odometry.frames);
  out.problem.planar = options.planar;
  out.reference = std::move(reference);
  out.provenance.sensor = "simulated";
  out.provenance.closures = out.problem.closures.empty() ? "none" : "simulated";
  out.provenance.licence = "none needed";
  out.provenance.noise = noise_text(options);
  return out;
}

void prepare_simulated(const SimulatedOptions& options) {
  const Sampling sampling = sampling_of(options, path_of(options.path));
  if (sampling.seconds * sampling.reference_rate > static_cast<double>(kMostSamplesKept)) return;
  sampled(options.path, sampling.reference_rate, sampling.seconds, options.planar);
}

DatasetEntry simulated_entry() {
  DatasetEntry out = dataset<SimulatedOptions>(
      "simulated", "closed-form paths with simulated odometry and loop closures", load_simulated);
  out.prepare = [](const Params& given) { prepare_simulated(with(SimulatedOptions{}, given)); };
  return out;
}

}  // namespace loopbench
