/// Tree of frames from recorded TF messages, interpolated in time.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "datasets/bags/messages.hpp"
#include "datasets/core/error.hpp"
#include "datasets/core/interpolate.hpp"

namespace loopbench {

class TransformTree {
 public:
  /// `bag`: its file, for errors; empty: not known.
  explicit TransformTree(const std::string& bag = "") : bag_(bag.empty() ? "" : bag + ": ") {}

  /// Adds a transform. A static transform holds at all times. Throws InputError if the frame
  /// already has another parent.
  void add(const PoseMessage& message, bool is_static) {
    Link& link = links_[message.child];
    if (!link.parent.empty() && link.parent != message.frame) {
      throw InputError(bag_ + "frame '" + message.child + "' has two parents, '" + link.parent +
                       "' and '" + message.frame + "', expected a tree of transforms");
    }
    link.parent = message.frame;
    link.is_static |= is_static;
    if (is_static) link.samples.clear();  // the last one holds
    link.samples.push_back(message);
    link.samples.back().frame_from_child.rotation.normalize();
  }

  /// Sorts the samples; call once after the last add().
  void finish() {
    for (auto& [child, link] : links_) {
      if (link.is_static) continue;
      std::ranges::stable_sort(link.samples, {}, &PoseMessage::nanoseconds);
      const auto same_stamp = [](const PoseMessage& a, const PoseMessage& b) {
        return a.nanoseconds == b.nanoseconds;
      };
      link.samples.erase(std::unique(link.samples.begin(), link.samples.end(), same_stamp),
                         link.samples.end());
    }
  }

  /// parent_from_child at the stamps of the transform on their connection that has most samples,
  /// where all others have samples before and after (or at) the stamp; linear in position, SLERP in
  /// rotation. Throws InputError with the known frames if they are not connected. O(samples).
  std::vector<PoseMessage> trajectory(const std::string& parent, const std::string& child) const {
    const std::vector<std::string> up = ancestors(parent);
    const std::vector<std::string> down = ancestors(child);
    const auto common = std::ranges::find_if(
        up, [&](const std::string& frame) { return std::ranges::count(down, frame) > 0; });
    if (common == up.end()) {
      std::string known;
      for (const std::string& frame : frames()) known += (known.empty() ? "" : ", ") + frame;
      throw InputError(bag_ + "no transforms connect '" + parent + "' and '" + child +
                       "' (frames: " + (known.empty() ? "none" : known) + ")");
    }
    std::vector<Step> steps;
    for (auto frame = up.begin(); frame != common; ++frame) {
      steps.push_back({&links_.at(*frame), true});
    }
    const auto end = std::ranges::find(down, *common);
    for (auto frame = end; frame != down.begin();) steps.push_back({&links_.at(*--frame), false});

    const Link* densest = nullptr;
    for (const Step& step : steps) {
      const bool is_denser =
          densest == nullptr || step.link->samples.size() > densest->samples.size();
      if (!step.link->is_static && is_denser) densest = step.link;
    }
    if (densest == nullptr) {
      throw InputError(bag_ + "the transform from '" + parent + "' to '" + child +
                       "' is static, expected one that moves");
    }
    std::vector<PoseMessage> out;
    for (const PoseMessage& sample : densest->samples) {
      PoseMessage pose{sample.nanoseconds, parent, child, {}};
      bool is_known = true;
      for (Step& step : steps) {
        const std::optional<Pose> next = sampled(step, sample.nanoseconds);
        is_known &= next.has_value();
        if (!is_known) break;
        pose.frame_from_child = pose.frame_from_child * *next;
      }
      if (!is_known) continue;
      pose.frame_from_child.rotation.normalize();
      out.push_back(pose);
    }
    return out;
  }

  /// All frames, sorted.
  std::vector<std::string> frames() const {
    std::set<std::string> out;
    for (const auto& [child, link] : links_) out.insert({child, link.parent});
    return {out.begin(), out.end()};
  }

 private:
  struct Link {
    std::string parent;
    bool is_static = false;
    std::vector<PoseMessage> samples;
  };
  /// One step of a connection between two frames.
  struct Step {
    const Link* link = nullptr;
    bool inverse = false;
    std::size_t at = 0;  ///< search position; stamps increase
  };
  std::vector<std::string> ancestors(const std::string& frame) const {
    std::vector<std::string> out{frame};
    for (auto at = links_.find(frame); at != links_.end(); at = links_.find(out.back())) {
      if (std::ranges::count(out, at->second.parent) > 0) {
        throw InputError(bag_ + "frame '" + frame +
                         "' is its own ancestor, expected a tree of transforms");
      }
      out.push_back(at->second.parent);
    }
    return out;
  }

  static std::optional<Pose> sampled(Step& step, std::int64_t nanoseconds) {
    const std::vector<PoseMessage>& samples = step.link->samples;
    Pose out = samples.front().frame_from_child;
    if (!step.link->is_static) {
      if (nanoseconds < samples.front().nanoseconds || nanoseconds > samples.back().nanoseconds) {
        return std::nullopt;
      }
      while (samples[step.at].nanoseconds < nanoseconds) ++step.at;
      const PoseMessage& after = samples[step.at];
      out = after.frame_from_child;
      if (after.nanoseconds != nanoseconds) {
        const PoseMessage& before = samples[step.at - 1];
        const double u = static_cast<double>(nanoseconds - before.nanoseconds) /
                         static_cast<double>(after.nanoseconds - before.nanoseconds);
        out = interpolate(before.frame_from_child, after.frame_from_child, u);
      }
    }
    return step.inverse ? out.inverse() : out;
  }

  std::string bag_;                    ///< for errors
  std::map<std::string, Link> links_;  ///< by child frame
};

}  // namespace loopbench
