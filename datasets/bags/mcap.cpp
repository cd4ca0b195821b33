// MCAP: records of an opcode, a length and content; messages are in chunks or at the top level.
// Source: mcap.dev/spec.
#include <fmt/format.h>

#include <map>

#include "datasets/bags/byte_reader.hpp"
#include "datasets/bags/messages.hpp"
#include "datasets/compressed/crc32.hpp"
#include "datasets/compressed/decompress.hpp"

namespace loopbench {
namespace {

constexpr std::uint64_t kMcapMagicBytes = 8;
constexpr std::uint64_t kMaxMcapChunk = 1u << 30;  // [bytes]

enum class McapOp : std::uint8_t {
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  chunk = 6,
  statistics = 11
};

class McapReader {
 public:
  McapReader(const OpenedFile& file, const WantsTopic& wants, const VisitMessage& visit)
      : file_(file), source_(file), wants_(wants), visit_(visit) {}

  BagSummary read() {
    constexpr std::uint64_t kRecordPrefix = 9;  // opcode and length
    std::uint64_t at = kMcapMagicBytes;
    try {
      while (!is_complete_) {
        ByteReader prefix(source_.bytes(at, kRecordPrefix));
        const auto op = static_cast<McapOp>(prefix.number<std::uint8_t>());
        const auto size = prefix.number<std::uint64_t>();
        if (size > source_.size() - at - kRecordPrefix) throw DamagedRecord("ends early");
        top_level(op, at + kRecordPrefix, size);
        at += kRecordPrefix + size;
      }
    } catch (const DamagedRecord&) {
      summary_.damage =
          fmt::format("ends early: has no footer, and its last {} of {} bytes are incomplete",
                      source_.size() - at,
                      source_.size());
    }
    if (damaged_chunks_ > 0) {
      summary_.add_damage(fmt::format("{} of {} chunks are damaged", damaged_chunks_, chunks_));
    }
    if (stated_messages_ > messages_) {
      summary_.add_damage(fmt::format(
          "{} of {} messages are missing", stated_messages_ - messages_, stated_messages_));
    }
    return std::move(summary_);
  }

 private:
  void top_level(McapOp op, std::uint64_t at, std::uint64_t size) {
    switch (op) {
      case McapOp::footer:
        is_complete_ = true;
        break;
      case McapOp::chunk:
        ++chunks_;
        try {
          records(chunk(source_.bytes(at, size)));
        } catch (const DamagedRecord&) {
          ++damaged_chunks_;
        } catch (const DamagedStream&) {
          ++damaged_chunks_;
        }
        break;
      case McapOp::statistics:
        stated_messages_ = ByteReader(source_.bytes(at, size)).number<std::uint64_t>();
        break;
      case McapOp::schema:
      case McapOp::channel:
      case McapOp::message:
        record(op, source_.bytes(at, size));
        break;
      default:  // attachments and indices
        break;
    }
  }

  std::string_view chunk(std::string_view bytes) {
    ByteReader reader(bytes);
    reader.bytes(2 * sizeof(std::uint64_t));  // first and last time
    const auto size = reader.number<std::uint64_t>();
    const auto crc = reader.number<std::uint32_t>();
    const std::string compression(reader.counted());
    const auto stored_size = reader.number<std::uint64_t>();
    const std::string_view stored = reader.bytes(stored_size);
    std::string_view out = stored;
    if (!compression.empty()) {
      if (compression != "zstd" && compression != "lz4") {
        throw file_.error("has chunks with compression '" + compression +
                          "', expected zstd, lz4 or none");
      }
      if (size > kMaxMcapChunk) throw DamagedRecord("has a chunk that is too large");
      const Codec codec = compression == "zstd" ? Codec::zstd : Codec::lz4;
      expanded_ = decompress(codec, stored, static_cast<std::size_t>(size));
      out = expanded_;
    }
    if (crc != 0 && crc != crc32_of(out)) throw DamagedRecord("has a wrong checksum");
    return out;
  }

  void records(std::string_view chunk) {
    for (ByteReader reader(chunk); reader.left() > 0;) {
      const auto op = static_cast<McapOp>(reader.number<std::uint8_t>());
      record(op, reader.bytes(reader.number<std::uint64_t>()));
    }
  }

  void record(McapOp op, std::string_view content) {
    ByteReader reader(content);
    const auto id = op == McapOp::schema || op == McapOp::channel || op == McapOp::message
                        ? reader.number<std::uint16_t>()
                        : std::uint16_t{0};
    if (op == McapOp::schema) {
      schemas_[id] = std::string(reader.counted());
    } else if (op == McapOp::channel) {
      const auto schema = schemas_.find(reader.number<std::uint16_t>());
      BagTopic topic{std::string(reader.counted()), schema == schemas_.end() ? "" : schema->second};
      const std::string_view encoding = reader.counted();
      const bool is_known = encoding == "cdr" || encoding == "ros1";
      topic.type = is_known ? message_type(topic.type_name) : MessageType::other;
      topic.encoding = encoding == "ros1" ? Encoding::ros1 : Encoding::cdr;
      add_topic(summary_, topic);
      channels_[id] = topic;
    } else if (op == McapOp::message) {
      ++messages_;
      constexpr std::uint64_t kSequenceAndTimes = 4 + 8 + 8;
      reader.bytes(kSequenceAndTimes);
      const auto found = channels_.find(id);
      if (found != channels_.end() && wants_(found->second)) {
        visit_(found->second, reader.bytes(reader.left()));
      }
    }
  }

  const OpenedFile& file_;
  BagSource source_;
  const WantsTopic& wants_;
  const VisitMessage& visit_;
  BagSummary summary_;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, BagTopic> channels_;
  std::string expanded_;
  bool is_complete_ = false;
  std::uint64_t chunks_ = 0;
  std::uint64_t damaged_chunks_ = 0;
  std::uint64_t messages_ = 0;
  std::uint64_t stated_messages_ = 0;
};

}  // namespace

BagSummary read_mcap(const OpenedFile& file, const WantsTopic& wants, const VisitMessage& visit) {
  return McapReader(file, wants, visit).read();
}

}  // namespace loopbench
