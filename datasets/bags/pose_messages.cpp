#include <limits>

#include "datasets/bags/byte_reader.hpp"
#include "datasets/bags/messages.hpp"

namespace loopbench {
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
