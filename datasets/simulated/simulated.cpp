#include "datasets/simulated/simulated.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <mutex>
#include <numbers>
#include <tuple>
#include <utility>

#include "datasets/derive/keyframes.hpp"
#include "datasets/noise/random.hpp"
#include "datasets/simulated/edges.hpp"
#include "datasets/simulated/options.hpp"
#include "datasets/simulated/path.hpp"

namespace loopbench {
namespace {

constexpr double kMaxPoses = 1e8;                  // 6.4 GB
constexpr std::size_t kMostSamplesKept = 100'000;  // [poses], 6.4 MB

Pose flattened(const Pose& pose) {
  const Vector3 ahead = pose.rotation * Vector3::UnitX();
  return {rotation_from_yaw_pitch_roll(std::atan2(ahead.y(), ahead.x()), 0.0, 0.0),
          {pose.translation.x(), pose.translation.y(), 0.0}};
}

Trajectory sample_path(SimulatedPath which, double rate, double seconds, bool planar) {
  // The factor prevents that rounding drops the last pose.
  const double steps = std::floor(seconds * rate * (1.0 + 1e-12));
  if (steps >= kMaxPoses) {
    throw OptionError("laps",
                      fmt::format("laps: {} s at {} Hz exceed {} poses", seconds, rate, kMaxPoses));
  }
  const Path path = path_of(which);
  Trajectory out(static_cast<std::size_t>(steps) + 1);
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double stamp = static_cast<double>(k) / rate;
    const Pose pose = path.at(stamp);
    out[k] = {stamp, planar ? flattened(pose) : pose};
  }
  return out;
}

using Arguments = std::tuple<SimulatedPath, double, double, bool>;

struct LastResult {
  std::mutex mutex;
  Arguments arguments{};
  std::shared_ptr<const Trajectory> poses;
};

/// Returns poses at k / rate from 0 to `seconds`, projected to x, y, yaw if `planar`. The last
/// result is cached, because repetitions with other noise use the same path and its evaluation
/// dominates the run time. Thread-safe. Throws OptionError for more than 1e8 poses. O(poses).
Trajectory sampled(SimulatedPath which, double rate, double seconds, bool planar) {
  static LastResult last;
  const Arguments arguments{which, rate, seconds, planar};
  std::shared_ptr<const Trajectory> cached;
  {
    const std::lock_guard lock(last.mutex);
    if (last.poses && last.arguments == arguments) cached = last.poses;
  }
  if (cached) return *cached;
  Trajectory out = sample_path(which, rate, seconds, planar);
  if (out.size() > kMostSamplesKept) return out;
  cached = std::make_shared<const Trajectory>(out);
  const std::lock_guard lock(last.mutex);
  last.arguments = arguments;
  last.poses = std::move(cached);
  return out;
}

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

std::string option_identity(const SimulatedOptions& options) {
  return identity_text("simulated", options, [](const std::string&) { return false; });
}

}  // namespace

Sequence load_simulated(const SimulatedOptions& options, const DataRoot&) {
  check_combination(options);
  const Path path = path_of(options.path);
  const Sampling sampling = sampling_of(options, path);
  const bool default_rate = options.reference_rate == 0.0;
  const auto count = static_cast<std::size_t>(
      options.keyframes > 0 ? options.keyframes : path.keyframes * options.laps);

  Trajectory reference =
      sampled(options.path, sampling.reference_rate, sampling.seconds, options.planar);
  const Trajectory truth =
      default_rate ? frames_of(reference)
                   : sampled(options.path, sampling.frame_rate, sampling.seconds, options.planar);
  if (count > truth.size()) {
    throw OptionError(
        "keyframes",
        fmt::format(
            "keyframes = {}: expected keyframes <= {}, the number of frames", count, truth.size()));
  }
  const std::vector<std::size_t> keyframes = even_indices(truth.size(), count);
  Odometry odometry = simulate_odometry(truth, keyframes, options);
  add_white_noise(odometry.frames, options);
  const SimulatedClosures& closures = options.closures;
  const RevisitRule same{closures.radius > 0.0 ? closures.radius : path.closure_radius,
                         closures.angle * std::numbers::pi / 180.0,
                         closures.min_gap};

  Sequence out;
  out.name = "simulated_" + to_text(options.path);
  out.problem.keyframes = split(odometry.frames, keyframes).keyframes;
  out.problem.odometry = std::move(odometry.edges);
  const Trajectory true_keyframes = split(truth, keyframes).keyframes;
  SimulatedLoops loops = simulate_closures(true_keyframes, same, options);
  out.problem.closures = std::move(loops.closures);
  out.false_closures = std::move(loops.false_ones);
  out.problem.anchors = simulate_anchors(true_keyframes, options);
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

void check_combination(const SimulatedOptions& o) {
  const SystematicDrift& d = o.drift;
  const std::pair<const char*, double> pitches[] = {{"drift.pitch_per_second", d.pitch_per_second},
                                                    {"drift.pitch_per_metre", d.pitch_per_metre},
                                                    {"drift.pitch_per_radian", d.pitch_per_radian}};
  for (const auto& [name, value] : pitches) {
    if (!o.planar || value == 0.0) continue;
    throw OptionError(name,
                      std::string(name) + " = " + to_text(value) +
                          ": causes motion out of the plane, expected 0 with planar = true");
  }
  if (o.closures.max == 0 && o.closures.false_share > 0.0) {
    throw OptionError(
        "closures.false_share",
        "closures.false_share = " + to_text(o.closures.false_share) +
            ": has no effect without true closures, expected 0 with closures.max = 0");
  }
}

NoiseStream noise_stream(const SimulatedOptions& o) {
  return {o.seed,
          o.stream.empty() ? noise_identity(option_identity(o), {}) : noise_identity(o.stream)};
}

std::string noise_text(const SimulatedOptions& o) {
  const std::string stream = o.stream.empty() ? option_identity(o) : "stream " + o.stream;
  return stream + "; seed " + std::to_string(o.seed);
}

}  // namespace loopbench
