#include "datasets/derive/keyframes.hpp"

#include <cmath>

#include "datasets/core/params.hpp"

namespace loopbench {
namespace {

constexpr double kSameStamp =
    1e-3;  // [s]; stamps in text are rounded, frames are at least 16 ms apart

OptionError invalid_value(const KeyframeChoice& choice, const std::string& expected) {
  return {"keyframes.value",
          "keyframes.value = " + to_text(choice.value) + ": expected " + expected};
}

std::size_t whole_number(const KeyframeChoice& choice, double low, const std::string& expected) {
  const double value = choice.value;
  if (!(value >= low && value <= 1e9) || value != std::floor(value))
    throw invalid_value(choice, expected);
  return static_cast<std::size_t>(value);
}

std::vector<std::size_t> every(std::size_t size, std::size_t step) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < size; i += step) kept.push_back(i);
  return kept;
}

/// Keeps each pose whose `distance` from the last kept pose is at least `minimum`.
template <class Distance>
std::vector<std::size_t> by_distance(const Trajectory& poses, double minimum, Distance distance) {
  std::vector<std::size_t> kept = {0};
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (distance(poses[kept.back()], poses[i]) >= minimum) kept.push_back(i);
  }
  return kept;
}

}  // namespace

std::vector<std::size_t> even_indices(std::size_t size, std::size_t count) {
  std::vector<std::size_t> out(count, 0);
  for (std::size_t k = 1; k < count; ++k) {
    out[k] = (2 * k * (size - 1) + count - 1) / (2 * (count - 1));  // rounded half up
  }
  return out;
}

std::vector<std::size_t> choose_keyframes(const Trajectory& poses, const KeyframeChoice& choice) {
  if (poses.empty()) return {};
  std::vector<std::size_t> kept;
  switch (choice.rule) {
    case KeyframeRule::all:
      return every(poses.size(), 1);
    case KeyframeRule::every:
      kept = every(poses.size(), whole_number(choice, 1, "a whole number of poses, 1 or more"));
      break;
    case KeyframeRule::count: {
      const std::size_t count = whole_number(choice, 2, "a whole number of keyframes, 2 or more");
      if (count > poses.size()) {
        throw invalid_value(
            choice, "at most the " + std::to_string(poses.size()) + " poses of the estimate");
      }
      return even_indices(poses.size(), count);
    }
    case KeyframeRule::seconds:
      if (!(choice.value > 0.0)) throw invalid_value(choice, "more than 0 seconds");
      // The tolerance of 1 us covers the rounding of stamp differences.
      kept =
          by_distance(poses, choice.value - 1e-6, [](const StampedPose& a, const StampedPose& b) {
            return b.stamp - a.stamp;
          });
      break;
    case KeyframeRule::metres:
      if (!(choice.value > 0.0)) throw invalid_value(choice, "more than 0 metres");
      kept = by_distance(poses, choice.value, [](const StampedPose& a, const StampedPose& b) {
        return (b.world_from_body.translation - a.world_from_body.translation).norm();
      });
      break;
  }
  if (kept.back() != poses.size() - 1) kept.push_back(poses.size() - 1);
  return kept;
}

KeyframeSplit split(const Trajectory& poses, const std::vector<std::size_t>& kept) {
  KeyframeSplit out;
  out.keyframes.reserve(kept.size());
  out.frames.reserve(poses.size() - kept.size());
  auto next = kept.begin();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const bool is_keyframe = next != kept.end() && *next == i;
    (is_keyframe ? out.keyframes : out.frames).push_back(poses[i]);
    if (is_keyframe) ++next;
  }
  return out;
}

Trajectory non_keyframes_between(const Trajectory& keyframes, const Trajectory& frames) {
  Trajectory out;
  std::size_t next = 0;  // first keyframe not before the frame
  for (const StampedPose& frame : frames) {
    while (next < keyframes.size() && keyframes[next].stamp < frame.stamp - kSameStamp) ++next;
    if (next == 0 && !keyframes.empty() && frame.stamp < keyframes[0].stamp) continue;
    if (next == keyframes.size()) break;
    if (std::abs(keyframes[next].stamp - frame.stamp) > kSameStamp) out.push_back(frame);
  }
  return out;
}

}  // namespace loopbench
