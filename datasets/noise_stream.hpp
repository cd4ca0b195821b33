/// Where a dataset's random draws come from: its seed and its identity.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "datasets/core/fields.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// Two streams with different identities are independent, even with equal seeds.
struct NoiseStream {
  std::int64_t seed = 1;
  std::uint64_t identity = 0;
};

/// A dataset's name and those of its options that differ from their defaults, as text:
/// "simulated: noise.gain=2.0, path=office". Left out are seeds, the option `stream` and what
/// `ignored` accepts. A default that is stated, an option that is added later and an option that is
/// renamed change nothing.
template <class Options, class Ignored>
std::string identity_text(const std::string& dataset, const Options& options, Ignored ignored) {
  const Params defaults = echo(Options{});
  Params changed;
  for (const auto& [name, value] : echo(options)) {
    const bool is_seed = name == "seed" || name.ends_with(".seed") || name == "stream";
    if (is_seed || ignored(name) || value == defaults.at(name)) continue;
    changed.emplace(first_name(dataset, name), value);
  }
  return dataset + ": " + to_text(changed);
}

/// Files and free text: they name the data, which noise_identity() takes from the poses instead,
/// so that a moved folder draws the same noise.
inline bool names_data(const std::string& option) {
  constexpr std::array kNames{"name",
                              "estimate",
                              "reference",
                              "frames",
                              "times",
                              "closures.file",
                              "path",
                              "truth",
                              "closures.true_list",
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
        "name of a noise stream: datasets with equal name and seed share their random numbers; "
        "empty: independent of all other datasets");
}

/// Of a named stream, which several datasets may share on purpose (common random numbers).
std::uint64_t noise_identity(const std::string& stream);

/// Of a dataset with a stream of its own: its text and the bits of the poses it is derived from.
/// O(poses).
std::uint64_t noise_identity(const std::string& text, const Trajectory& poses);

}  // namespace loopbench
