/// Writes small bags for tests, byte by byte after the formats' specifications.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

#include "datasets/core/trajectory.hpp"

namespace loopbench::test {

class Bytes {
 public:
  template <class T>
  Bytes& put(T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    text_.append(raw, sizeof(T));
    return *this;
  }
  Bytes& raw(const std::string& text) {
    text_ += text;
    return *this;
  }
  /// A text preceded by its length in 32 bits.
  Bytes& counted(const std::string& text) {
    return put(static_cast<std::uint32_t>(text.size())).raw(text);
  }
  Bytes& pose(const Pose& pose) {
    for (const double value : pose.translation) put(value);
    for (const double value : pose.rotation.coeffs()) put(value);
    return *this;
  }
  /// Padding of CDR before a value of this size.
  Bytes& align(std::size_t size) {
    while ((text_.size() - 4) % size != 0) text_ += '\0';
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

inline std::string ros1_pose_stamped(std::int64_t nanoseconds, const Pose& pose) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  return Bytes()
      .put(std::uint32_t{7})
      .put(static_cast<std::uint32_t>(nanoseconds / kSecond))
      .put(static_cast<std::uint32_t>(nanoseconds % kSecond))
      .counted("world")
      .pose(pose)
      .text();
}

inline std::string cdr_pose_stamped(std::int64_t nanoseconds, const Pose& pose) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  return Bytes()
      .raw(std::string("\0\1\0\0", 4))
      .put(static_cast<std::int32_t>(nanoseconds / kSecond))
      .put(static_cast<std::uint32_t>(nanoseconds % kSecond))
      .counted(std::string("world\0", 6))
      .align(8)
      .pose(pose)
      .text();
}

inline std::string ros1_field(const std::string& name, const std::string& value) {
  return Bytes().counted(name + "=" + value).text();
}

inline std::string ros1_record(const std::string& header, const std::string& data) {
  return Bytes().counted(header).counted(data).text();
}

template <class T>
std::string bytes_of(T value) {
  return Bytes().put(value).text();
}

/// A ROS 1 bag with one topic, /pose, and one uncompressed chunk for each `per_chunk` messages.
inline std::string ros1_bag(const std::vector<std::string>& messages, std::size_t per_chunk = 1) {
  const std::string connection =
      ros1_record(ros1_field("op", "\7") + ros1_field("conn", bytes_of(std::uint32_t{0})) +
                      ros1_field("topic", "/pose"),
                  ros1_field("type", "geometry_msgs/PoseStamped"));
  std::string chunks;
  for (std::size_t i = 0; i < messages.size(); i += per_chunk) {
    std::string records = connection;
    for (std::size_t j = i; j < std::min(messages.size(), i + per_chunk); ++j) {
      records +=
          ros1_record(ros1_field("op", "\2") + ros1_field("conn", bytes_of(std::uint32_t{0})) +
                          ros1_field("time", bytes_of(std::uint64_t{0})),
                      messages[j]);
    }
    chunks +=
        ros1_record(ros1_field("op", "\5") + ros1_field("compression", "none") +
                        ros1_field("size", bytes_of(static_cast<std::uint32_t>(records.size()))),
                    records);
  }
  const auto header = [&](std::uint64_t end) {
    return ros1_record(ros1_field("op", "\3") + ros1_field("index_pos", bytes_of(end)) +
                           ros1_field("conn_count", bytes_of(std::uint32_t{1})) +
                           ros1_field("chunk_count",
                                      bytes_of(static_cast<std::uint32_t>(
                                          (messages.size() + per_chunk - 1) / per_chunk))),
                       std::string(100, ' '));
  };
  const std::string magic = "#ROSBAG V2.0\n";
  const std::uint64_t end = magic.size() + header(0).size() + chunks.size();
  return magic + header(end) + chunks;
}

inline std::string mcap_record(std::uint8_t op, const std::string& content) {
  return Bytes().put(op).put(std::uint64_t{content.size()}).raw(content).text();
}

/// An MCAP with one topic, /pose, and one chunk for each message.
inline std::string mcap(const std::vector<std::string>& messages) {
  std::string out = "\x89MCAP0\r\n";
  const std::string schema = mcap_record(3,
                                         Bytes()
                                             .put(std::uint16_t{1})
                                             .counted("geometry_msgs/msg/PoseStamped")
                                             .counted("ros2msg")
                                             .counted("")
                                             .text());
  const std::string channel = mcap_record(4,
                                          Bytes()
                                              .put(std::uint16_t{1})
                                              .put(std::uint16_t{1})
                                              .counted("/pose")
                                              .counted("cdr")
                                              .counted("")
                                              .text());
  for (const std::string& message : messages) {
    const std::string records = schema + channel +
                                mcap_record(5,
                                            Bytes()
                                                .put(std::uint16_t{1})
                                                .put(std::uint32_t{0})
                                                .put(std::uint64_t{0})
                                                .put(std::uint64_t{0})
                                                .raw(message)
                                                .text());
    out += mcap_record(6,
                       Bytes()
                           .put(std::uint64_t{0})
                           .put(std::uint64_t{0})
                           .put(std::uint64_t{records.size()})
                           .put(std::uint32_t{0})
                           .counted("")
                           .put(std::uint64_t{records.size()})
                           .raw(records)
                           .text());
  }
  out += mcap_record(11,
                     Bytes().put(std::uint64_t{messages.size()}).raw(std::string(30, '\0')).text());
  return out + mcap_record(2, std::string(20, '\0')) + "\x89MCAP0\r\n";
}

}  // namespace loopbench::test
