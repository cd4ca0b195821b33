#include "datasets/bags/messages.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>

#include "datasets/bags/byte_reader.hpp"

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
  static constexpr std::array<std::pair<std::string_view, MessageType>, 9> kTypes{
      {{"geometry_msgs/PoseStamped", MessageType::pose_stamped},
       {"geometry_msgs/PoseWithCovarianceStamped", MessageType::pose_with_covariance_stamped},
       {"nav_msgs/Odometry", MessageType::odometry},
       {"geometry_msgs/TransformStamped", MessageType::transform_stamped},
       {"geometry_msgs/PointStamped", MessageType::point_stamped},
       {"sensor_msgs/NavSatFix", MessageType::nav_sat_fix},
       {"nav_msgs/Path", MessageType::path},
       {"tf2_msgs/TFMessage", MessageType::tf},
       {"tf/tfMessage", MessageType::tf}}};
  std::string plain(name);
  if (const std::size_t at = plain.find("/msg/"); at != plain.npos) plain.erase(at, 4);
  const auto found = std::ranges::find(kTypes, plain, [](const auto& type) { return type.first; });
  return found == kTypes.end() ? MessageType::other : found->second;
}

void add_topic(BagSummary& summary, const BagTopic& topic) {
  const auto at = std::ranges::lower_bound(summary.topics, topic.name, {}, &BagTopic::name);
  if (at == summary.topics.end() || at->name != topic.name) summary.topics.insert(at, topic);
}

namespace {

/// Values of a ROS 1 message, which are packed, or of a CDR message, where each value is aligned to
/// its size, counted from the end of a header of four bytes.
class MessageReader {
 public:
  MessageReader(Encoding encoding, std::string_view bytes) : reader_(bytes), encoding_(encoding) {
    if (!is_cdr()) return;
    const auto high = reader_.number<std::uint8_t>();
    const auto kind = reader_.number<std::uint8_t>();
    reader_.bytes(2);  // options
    constexpr std::uint8_t kXcdr1BigEndian = 0, kXcdr1 = 1, kXcdr2BigEndian = 6, kXcdr2 = 7;
    if (high != 0 ||
        (kind != kXcdr1BigEndian && kind != kXcdr1 && kind != kXcdr2BigEndian && kind != kXcdr2)) {
      throw DamagedRecord("has an unknown CDR encapsulation");
    }
    reader_.set_big_endian(kind == kXcdr1BigEndian || kind == kXcdr2BigEndian);
    if (kind == kXcdr2 || kind == kXcdr2BigEndian) largest_alignment_ = 4;
  }

  bool is_cdr() const { return encoding_ == Encoding::cdr; }

  template <class T>
  T number() {
    if (is_cdr()) {
      const std::size_t alignment = std::min(sizeof(T), largest_alignment_);
      reader_.bytes((alignment - (reader_.position() - 4) % alignment) % alignment);
    }
    return reader_.number<T>();
  }

  std::string text() {
    std::string out(reader_.bytes(number<std::uint32_t>()));
    if (is_cdr() && !out.empty() && out.back() == '\0') out.pop_back();
    return out;
  }

  std::string frame() {
    const std::string out = text();
    return out.starts_with('/') ? out.substr(1) : out;
  }

  Vector3 vector() {
    const auto x = number<double>();
    const auto y = number<double>();
    return {x, y, number<double>()};
  }

  Pose pose() {
    Pose out;
    out.translation = vector();
    out.rotation.vec() = vector();
    out.rotation.w() = number<double>();
    return out;
  }

  /// Of position and rotation, or of the position alone (`size` 3).
  Matrix6 covariance(int size = 6) {
    Matrix6 out = Matrix6::Zero();
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j < size; ++j) out(i, j) = number<double>();
    }
    return out;
  }

  /// Stamp and frame; the sequence number exists in ROS 1 only.
  PoseMessage header() {
    constexpr std::int64_t kPerSecond = 1'000'000'000;
    PoseMessage out;
    if (!is_cdr()) number<std::uint32_t>();
    const std::int64_t seconds =
        is_cdr() ? std::int64_t{number<std::int32_t>()} : std::int64_t{number<std::uint32_t>()};
    out.nanoseconds = seconds * kPerSecond + number<std::uint32_t>();
    out.frame = frame();
    return out;
  }

  PoseMessage pose_stamped() {
    PoseMessage out = header();
    out.frame_from_child = pose();
    return out;
  }

  /// A message without a fix has a position that is not finite.
  PoseMessage nav_sat_fix() {
    PoseMessage out = header();
    const auto status = number<std::int8_t>();
    number<std::uint16_t>();  // satellite systems
    out.frame_from_child = {no_rotation(), vector()};
    if (status < 0) {
      out.frame_from_child.translation.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    const Matrix6 stated = covariance(3);  // east, north, up
    if (number<std::uint8_t>() != 0) out.covariance = stated;
    return out;
  }

  PoseMessage transform_stamped() {
    PoseMessage out = header();
    out.child = frame();
    out.frame_from_child = pose();
    return out;
  }

 private:
  ByteReader reader_;
  Encoding encoding_;
  std::size_t largest_alignment_ = 8;
};

}  // namespace

std::vector<PoseMessage> decode(const BagTopic& topic, std::string_view message) {
  MessageReader reader(topic.encoding, message);
  std::vector<PoseMessage> out;
  switch (topic.type) {
    case MessageType::pose_stamped:
      out.push_back(reader.pose_stamped());
      break;
    case MessageType::pose_with_covariance_stamped:
      out.push_back(reader.pose_stamped());
      out.back().covariance = reader.covariance();
      break;
    case MessageType::odometry:
      out.push_back(reader.header());
      out.back().child = reader.frame();
      out.back().frame_from_child = reader.pose();
      out.back().covariance = reader.covariance();
      break;
    case MessageType::transform_stamped:
      out.push_back(reader.transform_stamped());
      break;
    case MessageType::point_stamped:
      out.push_back(reader.header());
      out.back().frame_from_child = {no_rotation(), reader.vector()};
      break;
    case MessageType::nav_sat_fix:
      out.push_back(reader.nav_sat_fix());
      break;
    case MessageType::path:
    case MessageType::tf: {
      if (topic.type == MessageType::path) reader.header();
      const auto count = reader.number<std::uint32_t>();
      for (std::uint32_t i = 0; i < count; ++i) {
        out.push_back(topic.type == MessageType::path ? reader.pose_stamped()
                                                      : reader.transform_stamped());
      }
      break;
    }
    case MessageType::other:
      break;
  }
  return out;
}

}  // namespace loopbench
