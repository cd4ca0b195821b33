// Source: mcap.dev/spec.
#include "datasets/bags/write_mcap.hpp"

#include <fmt/format.h>

#include <limits>

#include "datasets/core/error.hpp"

namespace loopbench {
namespace {

constexpr std::string_view kMcapMark = "\x89MCAP0\r\n";
constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::uint16_t kId = 1;  // of the only schema and the only channel

/// Definitions of ROS 2, as `ros2 interface show` prints them, each type after its users.
constexpr const char* kPoseFields = R"(std_msgs/Header header
geometry_msgs/Pose pose
)";
constexpr const char* kPoseWithCovarianceFields = R"(std_msgs/Header header
geometry_msgs/PoseWithCovariance pose
================================================================================
MSG: geometry_msgs/PoseWithCovariance
geometry_msgs/Pose pose
float64[36] covariance
)";
constexpr const char* kTypes =
    R"(================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
)";

/// Little-endian bytes.
class ByteWriter {
 public:
  template <class T>
  ByteWriter& number(T value) {
    static_assert(std::endian::native == std::endian::little);
    out_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    return *this;
  }
  ByteWriter& bytes(std::string_view text) {
    out_ += text;
    return *this;
  }
  /// Preceded by its length in 32 bits.
  ByteWriter& counted(std::string_view text) {
    return number(static_cast<std::uint32_t>(text.size())).bytes(text);
  }
  ByteWriter& record(std::uint8_t op, const ByteWriter& content) {
    return number(op).number(std::uint64_t{content.size()}).bytes(content.out_);
  }
  std::size_t size() const { return out_.size(); }
  const std::string& text() const { return out_; }

 private:
  std::string out_;
};

std::string pose_message(const Pose& pose, std::int64_t nanoseconds, const Matrix6* covariance) {
  using namespace std::string_view_literals;
  ByteWriter out;
  out.bytes("\0\1\0\0"sv)  // CDR, little-endian
      .number(static_cast<std::int32_t>(nanoseconds / kNanosecondsPerSecond))
      .number(static_cast<std::uint32_t>(nanoseconds % kNanosecondsPerSecond))
      .counted("map\0"sv);  // ends at a multiple of 8 after the encapsulation
  for (const double value : pose.translation) out.number(value);
  for (const double value : pose.rotation.coeffs()) out.number(value);  // x y z w
  if (covariance != nullptr) {
    for (const double value : covariance->reshaped()) out.number(value);  // symmetric
  }
  return out.text();
}

void check_stamps(const std::vector<std::int64_t>& nanoseconds) {
  constexpr std::int64_t kLast = std::numeric_limits<std::int32_t>::max();
  for (const std::int64_t stamp : nanoseconds) {
    if (stamp >= 0 && stamp / kNanosecondsPerSecond <= kLast) continue;
    throw InputError(fmt::format(
        "stamp {} ns: ROS 2 messages have stamps from 0 to {} s after 1970", stamp, kLast));
  }
}

}  // namespace

std::string mcap_of(const Trajectory& poses,
                    const std::vector<std::int64_t>& nanoseconds,
                    const std::string& topic,
                    const std::vector<Matrix6>& covariances) {
  enum : std::uint8_t {
    kHeader = 1,
    kFooter,
    kSchema,
    kChannel,
    kMessage,
    kChunk,
    kMessageIndex,
    kChunkIndex,
    kStatistics = 11,
    kDataEnd = 15
  };
  check_stamps(nanoseconds);
  const auto first = static_cast<std::uint64_t>(nanoseconds.front());
  const auto last = static_cast<std::uint64_t>(nanoseconds.back());
  const bool is_uncertain = !covariances.empty();
  ByteWriter definitions;
  definitions.record(
      kSchema,
      ByteWriter()
          .number(kId)
          .counted(is_uncertain ? "geometry_msgs/msg/PoseWithCovarianceStamped"
                                : "geometry_msgs/msg/PoseStamped")
          .counted("ros2msg")
          .counted((is_uncertain ? kPoseWithCovarianceFields : kPoseFields) + std::string(kTypes)));
  definitions.record(
      kChannel, ByteWriter().number(kId).number(kId).counted(topic).counted("cdr").counted(""));
  ByteWriter records = definitions;
  ByteWriter index;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto stamp = static_cast<std::uint64_t>(nanoseconds[i]);
    index.number(stamp).number(std::uint64_t{records.size()});
    records.record(kMessage,
                   ByteWriter()
                       .number(kId)
                       .number(static_cast<std::uint32_t>(i))
                       .number(stamp)  // of the record, and of the publication
                       .number(stamp)
                       .bytes(pose_message(poses[i].world_from_body,
                                           nanoseconds[i],
                                           is_uncertain ? &covariances[i] : nullptr)));
  }
  const std::uint64_t size = records.size();
  constexpr std::uint32_t kNoChecksum = 0;
  ByteWriter out;
  out.bytes(kMcapMark).record(kHeader, ByteWriter().counted("ros2").counted("loopbench"));
  const std::uint64_t chunk_start = out.size();
  out.record(kChunk,
             ByteWriter()
                 .number(first)
                 .number(last)
                 .number(size)
                 .number(kNoChecksum)
                 .counted("")
                 .number(size)
                 .bytes(records.text()));
  const std::uint64_t index_start = out.size();
  out.record(kMessageIndex, ByteWriter().number(kId).counted(index.text()));
  const std::uint64_t index_end = out.size();
  out.record(kDataEnd, ByteWriter().number(kNoChecksum));
  const std::uint64_t summary_start = out.size();
  out.bytes(definitions.text());
  const ByteWriter count = ByteWriter().number(kId).number(std::uint64_t{poses.size()});
  out.record(kStatistics,
             ByteWriter()
                 .number(std::uint64_t{poses.size()})
                 .number(std::uint16_t{1})  // schemas, channels, attachments, metadata, chunks
                 .number(std::uint32_t{1})
                 .number(std::uint32_t{0})
                 .number(std::uint32_t{0})
                 .number(std::uint32_t{1})
                 .number(first)
                 .number(last)
                 .counted(count.text()));
  out.record(kChunkIndex,
             ByteWriter()
                 .number(first)
                 .number(last)
                 .number(chunk_start)
                 .number(index_start - chunk_start)
                 .counted(ByteWriter().number(kId).number(index_start).text())
                 .number(index_end - index_start)
                 .counted("")
                 .number(size)
                 .number(size));
  constexpr std::uint64_t kNoOffsets = 0;
  out.record(kFooter, ByteWriter().number(summary_start).number(kNoOffsets).number(kNoChecksum));
  return out.bytes(kMcapMark).text();
}

}  // namespace loopbench
