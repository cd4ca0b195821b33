/// Steps of the odometry that the user states to be of unknown motion.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/core/params.hpp"
#include "datasets/core/problem.hpp"
#include "datasets/derive/odometry.hpp"
#include "datasets/derive/poses_at.hpp"

namespace loopbench {

/// Information of a step of unknown motion among these keyframes: deviations of the size of the map
/// (at least 1 m) and of half a turn, beyond which an angle repeats. Methods that judge steps take
/// such a rotation for not measured. O(keyframes).
inline Matrix6 unknown_information(const Trajectory& keyframes) {
  double size = 1.0;  // [m]
  for (const StampedPose& each : keyframes) {
    const Vector3 offset =
        each.world_from_body.translation - keyframes.front().world_from_body.translation;
    size = std::max(size, 2.0 * offset.norm());
  }
  return isotropic_information(size * size, std::numbers::pi * std::numbers::pi);
}

/// Words between blanks and commas.
inline std::vector<std::string> break_words(const std::string& text) {
  std::vector<std::string> out;
  std::string word;
  for (const char c : text + " ") {
    if (c != ' ' && c != '\t' && c != ',') {
      word += c;
    } else if (!word.empty()) {
      out.push_back(std::exchange(word, ""));
    }
  }
  return out;
}

/// The number that is the whole word. Throws OptionError.
inline double number_in(const std::string& word, const char* expected) {
  double out = 0.0;
  const char* const end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, out);
  if (error == std::errc{} && rest == end) return out;
  throw OptionError("breaks", "breaks: found '" + word + "', expected " + expected);
}

inline void require_later_pose(std::size_t index, const std::string& word) {
  if (index > 0) return;
  throw OptionError(
      "breaks",
      "breaks: " + word + " is the first pose, at which no step arrives, expected a later one");
}

inline std::vector<std::size_t> sorted_once(std::vector<std::size_t> of) {
  std::ranges::sort(of);
  of.erase(std::unique(of.begin(), of.end()), of.end());
  return of;
}

/// Indices of the poses at which maps begin, ascending: `breaks` are their stamps, separated by
/// blanks or commas, each within `max_diff` of one [s]. Throws OptionError for other words, stamps
/// and for the first pose, at which no step arrives.
inline std::vector<std::size_t> breaks_at_stamps(const std::string& breaks,
                                                 const Trajectory& poses,
                                                 double max_diff) {
  std::vector<std::size_t> out;
  for (const std::string& word : break_words(breaks)) {
    const auto stamp = number_in(word, "the stamp of a pose [s]");
    const auto index = nearest_pose(poses, stamp, max_diff);
    if (!index) {
      const auto nearest = nearest_pose(poses, stamp, std::numeric_limits<double>::infinity());
      throw OptionError(
          "breaks",
          fmt::format(
              "breaks: no pose is within {} s of {}{}",
              max_diff,
              word,
              nearest ? ", the nearest is at " + to_text(poses[*nearest].stamp) + " s" : ""));
    }
    require_later_pose(*index, word);
    out.push_back(*index);
  }
  return sorted_once(std::move(out));
}

/// The same for ids of vertices, ascending; symbols of GTSAM are letter and index, a12, or numbers.
inline std::vector<std::size_t> breaks_at_ids(const std::string& breaks,
                                              const std::vector<std::int64_t>& ids) {
  std::vector<std::size_t> out;
  for (const std::string& word : break_words(breaks)) {
    const std::optional<std::int64_t> id = id_of(word);
    if (!id) {
      throw OptionError("breaks", "breaks: found '" + word + "', expected the id of a vertex");
    }
    const auto found = std::ranges::lower_bound(ids, *id);
    if (found == ids.end() || *found != *id) {
      throw OptionError("breaks",
                        fmt::format("breaks: no vertex has id {}, expected one from {} to {}",
                                    word,
                                    id_text(ids.empty() ? 0 : ids.front()),
                                    id_text(ids.empty() ? 0 : ids.back())));
    }
    const auto index = static_cast<std::size_t>(found - ids.begin());
    require_later_pose(index, word);
    out.push_back(index);
  }
  return sorted_once(std::move(out));
}

/// Gives the steps that arrive at these keyframes the information of an unknown motion. Steps
/// without odometry stay without. O(keyframes + breaks).
inline void free_steps(Problem& problem, const std::vector<std::size_t>& arriving) {
  if (arriving.empty()) return;
  const Matrix6 information = unknown_information(problem.keyframes);
  for (Edge& edge : problem.odometry) {
    if (std::ranges::binary_search(arriving, edge.to)) edge.information = information;
  }
}

/// For the provenance: which steps have unknown motion. Requires at least one.
inline std::string breaks_note(const Problem& problem, const std::vector<std::size_t>& arriving) {
  std::string out = "breaks: unknown motion";
  for (std::size_t i = 0; i < arriving.size(); ++i) {
    out += fmt::format("{} from {} to {}",
                       i == 0 ? "" : ",",
                       problem.name_of(arriving[i] - 1),
                       problem.name_of(arriving[i]));
  }
  return out;
}

}  // namespace loopbench
