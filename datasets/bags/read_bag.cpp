#include <algorithm>
#include <filesystem>

#include "datasets/bags/byte_reader.hpp"
#include "datasets/bags/messages.hpp"

namespace loopbench {
namespace {

using namespace std::string_view_literals;

BagSummary read_bag_file(const std::string& name,
                         const WantsTopic& wants,
                         const VisitMessage& visit) {
  const OpenedFile file = open_input(name, "a ROS bag");
  switch (bag_kind(file)) {
    case BagKind::ros1:
      return read_ros1_bag(file, wants, visit);
    case BagKind::mcap:
      return read_mcap(file, wants, visit);
    case BagKind::db3:
      return read_db3(file, wants, visit);
    case BagKind::none:
      break;
  }
  throw file.error("is not a ROS bag, expected a .bag of ROS 1 (format 2.0), a .db3 or an .mcap");
}

}  // namespace

BagKind bag_kind(const OpenedFile& file) {
  constexpr std::uint64_t kLongestMagic = 16;
  BagSource source(file);
  const std::string_view start = source.bytes(0, std::min(kLongestMagic, source.size()));
  if (start.starts_with("#ROSBAG V2.0\n"sv)) return BagKind::ros1;
  if (start.starts_with("\x89MCAP0\r\n"sv)) return BagKind::mcap;
  if (start.starts_with("SQLite format 3\0"sv)) return BagKind::db3;
  return BagKind::none;
}

BagSummary read_bag(const std::string& name, const WantsTopic& wants, const VisitMessage& visit) {
  if (!std::filesystem::is_directory(name)) return read_bag_file(name, wants, visit);
  std::vector<std::filesystem::path> parts;
  for (const auto& entry : std::filesystem::directory_iterator(name)) {
    const std::string file = entry.path().filename().string();
    if (file.find(".db3") != file.npos || file.find(".mcap") != file.npos) {
      parts.push_back(entry.path());
    }
  }
  if (parts.empty()) {
    throw input_error(name, 0, "is a folder without .db3 or .mcap files, expected a ROS 2 bag");
  }
  std::ranges::sort(parts);
  BagSummary out;
  for (const std::filesystem::path& part : parts) {
    const BagSummary read = read_bag_file(part.string(), wants, visit);
    for (const BagTopic& topic : read.topics) add_topic(out, topic);
    if (!read.damage.empty()) out.add_damage(part.filename().string() + ": " + read.damage);
  }
  return out;
}

MessageType message_type(std::string_view name) {
  std::string plain(name);
  if (const std::size_t at = plain.find("/msg/"); at != plain.npos) plain.erase(at, 4);
  if (plain == "geometry_msgs/PoseStamped") return MessageType::pose_stamped;
  if (plain == "geometry_msgs/PoseWithCovarianceStamped") {
    return MessageType::pose_with_covariance_stamped;
  }
  if (plain == "nav_msgs/Odometry") return MessageType::odometry;
  if (plain == "geometry_msgs/TransformStamped") return MessageType::transform_stamped;
  if (plain == "geometry_msgs/PointStamped") return MessageType::point_stamped;
  if (plain == "sensor_msgs/NavSatFix") return MessageType::nav_sat_fix;
  if (plain == "nav_msgs/Path") return MessageType::path;
  if (plain == "tf2_msgs/TFMessage" || plain == "tf/tfMessage") return MessageType::tf;
  return MessageType::other;
}

void add_topic(BagSummary& summary, const BagTopic& topic) {
  const auto at = std::ranges::lower_bound(summary.topics, topic.name, {}, &BagTopic::name);
  if (at == summary.topics.end() || at->name != topic.name) summary.topics.insert(at, topic);
}

}  // namespace loopbench
