/// Messages of a bag, as recorded, and the poses in them.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/bags/byte_reader.hpp"
#include "datasets/core/se3.hpp"

namespace loopbench {

enum class Encoding { ros1, cdr };

/// Serialised types that contain poses.
enum class MessageType {
  pose_stamped,
  pose_with_covariance_stamped,
  odometry,
  transform_stamped,
  point_stamped,  ///< positions without rotation
  nav_sat_fix,    ///< latitude, longitude [deg] and height instead of x, y and z
  path,
  tf,
  other
};

struct BagTopic {
  std::string name;
  std::string type_name;  ///< "nav_msgs/msg/Odometry"
  MessageType type = MessageType::other;
  Encoding encoding = Encoding::ros1;
};

/// "nav_msgs/Odometry" and "nav_msgs/msg/Odometry" -> odometry. Types without a position are
/// `other`.
MessageType message_type(std::string_view name);

/// Whether messages of this type have a position, but no rotation.
inline bool has_only_positions(MessageType type) {
  return type == MessageType::point_stamped || type == MessageType::nav_sat_fix;
}

/// Called for each message of a wanted topic, in the order of the file.
using VisitMessage = std::function<void(const BagTopic&, std::string_view message)>;
using WantsTopic = std::function<bool(const BagTopic&)>;

struct BagSummary {
  std::vector<BagTopic> topics;  ///< sorted by name, each once
  std::string damage;            ///< what is missing; empty: intact

  void add_damage(const std::string& what) { damage += (damage.empty() ? "" : "; ") + what; }
};

/// Readers of the three containers. They visit all messages that can be read. Throw InputError if
/// nothing can, and MissingPart for an unsupported compression. Memory: one chunk. O(bytes).
BagSummary read_ros1_bag(const OpenedFile& file,
                         const WantsTopic& wants,
                         const VisitMessage& visit);
BagSummary read_mcap(const OpenedFile& file, const WantsTopic& wants, const VisitMessage& visit);
BagSummary read_db3(const OpenedFile& file, const WantsTopic& wants, const VisitMessage& visit);

enum class BagKind { none, ros1, mcap, db3 };

/// Detects the container from the first bytes.
BagKind bag_kind(const OpenedFile& file);

/// Reads any container; `file` can also be the folder of a ROS 2 recording, whose parts are read in
/// the order of their names. Throws InputError if it is none.
BagSummary read_bag(const std::string& file, const WantsTopic& wants, const VisitMessage& visit);

/// Adds a topic unless one of that name is known.
void add_topic(BagSummary& summary, const BagTopic& topic);

/// A pose of `child` in `frame`; the quaternion as recorded, not normalised.
struct PoseMessage {
  std::int64_t nanoseconds = 0;  ///< of the message's header
  std::string frame;             ///< without leading '/'
  std::string child;             ///< "" for poses without child frame
  Pose frame_from_child;
  /// In the axes of `frame`, rotation after position; zeros for the rotation of a position.
  std::optional<Matrix6> covariance = {};
};

/// The poses of one message: several for Path and TF. Throws DamagedRecord. O(bytes).
std::vector<PoseMessage> decode(const BagTopic& topic, std::string_view message);

}  // namespace loopbench
