/// Random stream of a dataset, given by its seed and its identity.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "datasets/core/fields.hpp"
#include "datasets/core/hash.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// Streams with different identities are independent, even with equal seeds.
struct NoiseStream {
  std::int64_t seed = 1;
  std::uint64_t identity = 0;
};

/// The name of an option in identity_text(): its first one, so that a renamed option draws the same
/// numbers.
inline std::string seeding_name(const std::string& option) {
  constexpr std::string_view kWhiteNoise = "white_noise.";
  return option.starts_with(kWhiteNoise) ? "shake." + option.substr(kWhiteNoise.size()) : option;
}

/// Dataset name and all options that differ from their defaults, as text:
/// "simulated: noise.gain=2.0, path=office". Seeds, the option `stream` and options accepted by
/// `ignored` are omitted. Setting an option to its default or adding a new option to the code does
/// not change the text.
template <class Options, class Ignored>
std::string identity_text(const std::string& dataset, const Options& options, Ignored ignored) {
  const Params defaults = echo(Options{});
  Params changed;
  for (const auto& [name, value] : echo(options)) {
    const bool is_seed = name == "seed" || name.ends_with(".seed") || name == "stream";
    if (is_seed || ignored(name) || value == defaults.at(name)) continue;
    changed.emplace(seeding_name(name), value);
  }
  return dataset + ": " + to_text(changed);
}

/// Whether an option is a file name or free text. These are excluded from identity_text(), because
/// noise_identity() hashes the poses instead: moving a folder does not change the noise. Likewise
/// `planar`, so that the same recording in SE(2) and in SE(3) is paired by seed.
inline bool is_data_option(const std::string& option) {
  constexpr std::array kNames{"name",
                              "estimate",
                              "reference",
                              "frames",
                              "times",
                              "closures.file",
                              "anchors.file",
                              "path",
                              "truth",
                              "closures.true_list",
                              "planar",
                              "sensor",
                              "licence"};
  for (const char* name : kNames) {
    if (option == name) return true;
  }
  return false;
}

template <class Visit>
void noise_stream_field(std::string& stream, Visit visit) {
  visit("stream",
        stream,
        "name of a shared noise stream: datasets with the same name and seed draw the same random "
        "numbers; empty: independent of all other datasets");
}

inline constexpr std::uint64_t kSharedStream = 1;
inline constexpr std::uint64_t kOwnStream = 2;

/// Identity of a named stream, which several datasets may share (common random numbers).
inline std::uint64_t noise_identity(const std::string& stream) {
  return hash_combine(kSharedStream, stream);
}

/// Identity of a dataset with its own stream: hash of its identity text and of the poses it is
/// derived from. O(poses).
inline std::uint64_t noise_identity(const std::string& text, const Trajectory& poses) {
  std::uint64_t out = hash_combine(kOwnStream, text);
  for (const auto& [stamp, pose] : poses) {
    const Vector3& t = pose.translation;
    const Rotation& q = pose.rotation;
    for (const double value : {stamp, t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z()}) {
      out = hash_combine(out, std::bit_cast<std::uint64_t>(value));
    }
  }
  return out;
}

}  // namespace loopbench
