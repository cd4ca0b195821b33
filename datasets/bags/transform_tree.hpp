/// Tree of frames from recorded TF messages, interpolated in time.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/bags/messages.hpp"

namespace loopbench {

class TransformTree {
 public:
  /// Adds a transform. A static transform holds at all times. Throws InputError if the frame
  /// already has another parent.
  void add(const PoseMessage& message, bool is_static);

  /// Sorts the samples; call once after the last add().
  void finish();

  /// parent_from_child at the stamps of the transform on their connection that has most samples,
  /// where all others have samples before and after (or at) the stamp; linear in position, SLERP in
  /// rotation. Throws InputError with the known frames if they are not connected. O(samples).
  std::vector<PoseMessage> trajectory(const std::string& parent, const std::string& child) const;

  /// All frames, sorted.
  std::vector<std::string> frames() const;

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
  std::vector<std::string> ancestors(const std::string& frame) const;
  static std::optional<Pose> sampled(Step& step, std::int64_t nanoseconds);

  std::map<std::string, Link> links_;  ///< by child frame
};

}  // namespace loopbench
