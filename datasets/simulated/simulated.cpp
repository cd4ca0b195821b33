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

/// The reference is sampled so much finer than the frames, unless told otherwise. A power of two,
/// so k / frame_rate and 4 k / (4 frame_rate) are the same bits and every frame has a reference
/// pose.
constexpr std::size_t kFiner = 4;

Trajectory every_finer_one(const Trajectory& reference) {
  Trajectory out;
  out.reserve(reference.size() / kFiner + 1);
  for (std::size_t i = 0; i < reference.size(); i += kFiner) out.push_back(reference[i]);
  return out;
}

/// `count` indices below `size`, even, both ends among them.
std::vector<std::size_t> chosen(std::size_t count, std::size_t size) {
  if (count > size) {
    throw OptionError(
        "keyframes",
        fmt::format("keyframes = {} breaks keyframes <= {}, the number of frames", count, size));
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

/// Each pose moved on its own, in the plane when `planar`.
void shake(Trajectory& poses, const SimulatedOptions& options) {
  const auto [sigma_t, sigma_r] = options.shake;
  if (sigma_t == 0.0 && sigma_r == 0.0) return;
  const Twist kept = options.planar ? twist({1.0, 1.0, 0.0}, {0.0, 0.0, 1.0}) : Twist::Ones();
  Random random(noise_stream(options), Purpose::shake);
  for (auto& [stamp, pose] : poses) {
    const Twist noise = kept.cwiseProduct(random.normal_twist(sigma_t, sigma_r));
    pose = normalized(pose * exp_se3(noise));
  }
}

}  // namespace

Sequence load_simulated(const SimulatedOptions& options, const DataRoot&) {
  check_combination(options);
  const Path path = path_of(options.path);
  const double seconds = path.duration * static_cast<double>(options.laps);
  const double frame_rate = options.frame_rate > 0.0 ? options.frame_rate : path.frame_rate;
  const bool finer = options.reference_rate == 0.0;
  const double reference_rate =
      finer ? static_cast<double>(kFiner) * frame_rate : options.reference_rate;
  const std::int64_t wanted =
      options.keyframes > 0 ? options.keyframes : path.keyframes * options.laps;

  Trajectory reference = sampled(options.path, reference_rate, seconds, options.planar);
  const Trajectory truth = finer ? every_finer_one(reference)
                                 : sampled(options.path, frame_rate, seconds, options.planar);
  const std::vector<std::size_t> keyframes = chosen(static_cast<std::size_t>(wanted), truth.size());
  Odometry odometry = measure_odometry(truth, keyframes, options);
  shake(odometry.frames, options);
  const SimulatedClosures& closures = options.closures;
  const RevisitRule same{closures.radius > 0.0 ? closures.radius : path.closure_radius,
                         closures.angle * std::numbers::pi / 180.0,
                         closures.min_gap};

  Sequence out;
  out.name = "simulated_" + to_text(options.path);
  out.problem.keyframes = at(keyframes, odometry.frames);
  out.problem.odometry = std::move(odometry.edges);
  out.problem.closures = measure_closures(at(keyframes, truth), same, options);
  out.problem.frames = std::move(odometry.frames);
  out.problem.planar = options.planar;
  out.reference = std::move(reference);
  out.provenance.sensor = "simulated";
  out.provenance.closures = out.problem.closures.empty() ? "none" : "simulated";
  out.provenance.licence = "none needed";
  out.provenance.noise = noise_text(options);
  return out;
}

}  // namespace loopbench
