// ROS 1 bag, format 2.0: records with a header of fields NAME=VALUE and data. Messages are in
// chunks; the index at the end is not needed. Source: wiki.ros.org/Bags/Format/2.0.
#include <fmt/format.h>

#include <map>

#include "datasets/bags/byte_reader.hpp"
#include "datasets/bags/messages.hpp"
#include "datasets/compressed/decompress.hpp"

namespace loopbench {
namespace {

constexpr std::string_view kRos1Magic = "#ROSBAG V2.0\n";
constexpr std::uint64_t kMaxRos1Header = 16u << 20;  // [bytes]
constexpr std::size_t kMaxRos1Chunk = 1u << 30;      // [bytes]

enum class Ros1Op : std::uint8_t { message = 2, bag_header = 3, chunk = 5, connection = 7 };

using Ros1Fields = std::map<std::string, std::string_view, std::less<>>;

Ros1Fields fields_of(std::string_view header) {
  Ros1Fields out;
  for (ByteReader reader(header); reader.left() > 0;) {
    const std::string_view field = reader.counted();
    const std::size_t equals = field.find('=');
    if (equals == field.npos) throw DamagedRecord("has a field without '='");
    out[std::string(field.substr(0, equals))] = field.substr(equals + 1);
  }
  return out;
}

template <class T>
T field(const Ros1Fields& fields, const char* name) {
  const auto found = fields.find(name);
  if (found == fields.end()) throw DamagedRecord(std::string("has no field ") + name);
  return ByteReader(found->second).number<T>();
}

std::string text_field(const Ros1Fields& fields, const char* name) {
  const auto found = fields.find(name);
  if (found == fields.end()) throw DamagedRecord(std::string("has no field ") + name);
  return std::string(found->second);
}

/// Interprets the records of one bag.
class Ros1Reader {
 public:
  Ros1Reader(const OpenedFile& file, const WantsTopic& wants, const VisitMessage& visit)
      : file_(file), source_(file), wants_(wants), visit_(visit) {}

  BagSummary read() {
    std::uint64_t at = kRos1Magic.size();
    std::uint64_t intact = at;
    try {
      while (at < source_.size()) {
        const std::uint64_t header_size = length(at);
        if (header_size > kMaxRos1Header) throw DamagedRecord("has a header that is too long");
        const std::string header(source_.bytes(at + 4, header_size));
        const std::uint64_t data = at + 4 + header_size;
        const std::uint64_t data_size = length(data);
        top_level(fields_of(header), data + 4, data_size);
        at = data + 4 + data_size;
        intact = at;
      }
    } catch (const DamagedRecord& damage) {
      why_ = damage.what();
    }
    state_damage(intact);
    return std::move(summary_);
  }

 private:
  std::uint64_t length(std::uint64_t at) {
    return ByteReader(source_.bytes(at, 4)).number<std::uint32_t>();
  }

  void top_level(const Ros1Fields& fields, std::uint64_t at, std::uint64_t size) {
    const auto op = static_cast<Ros1Op>(field<std::uint8_t>(fields, "op"));
    if (at + size > source_.size()) throw DamagedRecord("ends early");
    if (op == Ros1Op::bag_header) {
      data_end_ = field<std::uint64_t>(fields, "index_pos");
      chunk_count_ = field<std::uint32_t>(fields, "chunk_count");
    } else if (op == Ros1Op::chunk) {
      ++chunks_;
      try {
        records(chunk(fields, source_.bytes(at, size)));
      } catch (const DamagedRecord&) {
        ++damaged_chunks_;
      } catch (const DamagedStream&) {
        ++damaged_chunks_;
      }
    } else {
      record(op, fields, op == Ros1Op::connection ? source_.bytes(at, size) : std::string_view());
    }
  }

  std::string_view chunk(const Ros1Fields& fields, std::string_view data) {
    const std::string compression = text_field(fields, "compression");
    const auto size = field<std::uint32_t>(fields, "size");
    if (compression == "none") return data;
    if (compression != "bz2" && compression != "lz4") {
      throw file_.error("has chunks with compression '" + compression +
                        "', expected none, bz2 or lz4");
    }
    if (size > kMaxRos1Chunk) throw DamagedRecord("has a chunk that is too large");
    const Codec codec = compression == "bz2" ? Codec::bzip2 : Codec::lz4;
    return expanded_ = decompress(codec, data, size);
  }

  void records(std::string_view chunk) {
    for (ByteReader reader(chunk); reader.left() > 0;) {
      const Ros1Fields fields = fields_of(reader.counted());
      const std::string_view data = reader.counted();
      record(static_cast<Ros1Op>(field<std::uint8_t>(fields, "op")), fields, data);
    }
  }

  void record(Ros1Op op, const Ros1Fields& fields, std::string_view data) {
    if (op == Ros1Op::connection) {
      BagTopic topic{text_field(fields, "topic"), text_field(fields_of(data), "type")};
      topic.type = message_type(topic.type_name);
      add_topic(summary_, topic);
      connections_[field<std::uint32_t>(fields, "conn")] = topic;
    } else if (op == Ros1Op::message) {
      const auto found = connections_.find(field<std::uint32_t>(fields, "conn"));
      if (found != connections_.end() && wants_(found->second)) visit_(found->second, data);
    }
  }

  void state_damage(std::uint64_t intact) {
    const std::uint64_t expected = std::max<std::uint64_t>(data_end_, source_.size());
    if (!why_.empty() || data_end_ > source_.size() || data_end_ == 0) {
      const std::uint64_t missing = expected - std::min(expected, intact);
      summary_.damage = fmt::format("{} of at least {} bytes are missing or damaged (from byte {})",
                                    missing,
                                    expected,
                                    intact);
      if (data_end_ == 0) summary_.damage = "was not closed; " + summary_.damage;
    }
    const std::uint64_t lost =
        damaged_chunks_ + (chunk_count_ > chunks_ ? chunk_count_ - chunks_ : 0);
    if (lost > 0) {
      summary_.add_damage(fmt::format("{} of {} chunks are missing or damaged",
                                      lost,
                                      std::max<std::uint64_t>(chunk_count_, chunks_)));
    }
  }

  const OpenedFile& file_;
  BagSource source_;
  const WantsTopic& wants_;
  const VisitMessage& visit_;
  BagSummary summary_;
  std::map<std::uint32_t, BagTopic> connections_;
  std::string expanded_;
  std::string why_;
  std::uint64_t data_end_ = 0;  ///< of messages, stated in the bag's header
  std::uint64_t chunk_count_ = 0;
  std::uint64_t chunks_ = 0;
  std::uint64_t damaged_chunks_ = 0;
};

}  // namespace

BagSummary read_ros1_bag(const OpenedFile& file,
                         const WantsTopic& wants,
                         const VisitMessage& visit) {
  return Ros1Reader(file, wants, visit).read();
}

}  // namespace loopbench
