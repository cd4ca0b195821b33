// ROS 2 bag in SQLite: tables topics(id, name, type, ...) and messages(id, topic_id, timestamp,
// data). Messages can be compressed one by one (compression_mode: message).
#include <fcntl.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <map>
#include <memory>

#include "datasets/bags/byte_reader.hpp"
#include "datasets/bags/messages.hpp"
#include "datasets/compressed/decompress.hpp"

namespace loopbench {
namespace {

constexpr std::size_t kMaxMessage = std::size_t{1} << 30;  // [bytes]

struct CloseDb3 {
  void operator()(sqlite3* handle) const { sqlite3_close(handle); }
  void operator()(sqlite3_stmt* handle) const { sqlite3_finalize(handle); }
};
using Db3 = std::unique_ptr<sqlite3, CloseDb3>;
using Db3Query = std::unique_ptr<sqlite3_stmt, CloseDb3>;

/// URI of a file that nobody writes: no locks, no journal.
std::string uri_of(const std::string& path) {
  std::string out = "file:";
  for (const char c : path) {
    const bool is_special = c == '%' || c == '?' || c == '#';
    out += is_special ? fmt::format("%{:02X}", static_cast<unsigned char>(c)) : std::string(1, c);
  }
  return out + "?immutable=1";
}

/// A file in memory, which has no path that SQLite can open: decompressed, or read from a pipe.
class MappedDb3 {
 public:
  explicit MappedDb3(const OpenedFile& file) : size_(file.size) {
    const int descriptor = open(file.path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) throw file.error(std::string("cannot be read: ") + std::strerror(errno));
    void* const bytes = mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_PRIVATE, descriptor, 0);
    const int reason = errno;
    close(descriptor);
    if (bytes == MAP_FAILED) {
      throw file.error(std::string("cannot be read: ") + std::strerror(reason));
    }
    bytes_ = static_cast<unsigned char*>(bytes);
    // SQLite rejects a database in memory that has a write-ahead log, which is a second file.
    constexpr std::size_t kWriteVersion = 18, kReadVersion = 19;
    if (size_ > kReadVersion) bytes_[kWriteVersion] = bytes_[kReadVersion] = 1;
  }
  ~MappedDb3() { munmap(bytes_, size_); }
  MappedDb3(const MappedDb3&) = delete;
  MappedDb3& operator=(const MappedDb3&) = delete;

  /// Replaces the content of `db`, which must be closed before this is destroyed.
  int attach(sqlite3* db) const {
    const auto size = static_cast<sqlite3_int64>(size_);
    return sqlite3_deserialize(db, "main", bytes_, size, size, SQLITE_DESERIALIZE_READONLY);
  }

 private:
  std::size_t size_ = 0;
  unsigned char* bytes_ = nullptr;
};

Db3 open_db3(const OpenedFile& file, const MappedDb3* mapped) {
  sqlite3* handle = nullptr;
  const int access = mapped == nullptr ? SQLITE_OPEN_READONLY | SQLITE_OPEN_URI
                                       : SQLITE_OPEN_READWRITE | SQLITE_OPEN_MEMORY;
  int code = sqlite3_open_v2(mapped == nullptr ? uri_of(file.path).c_str() : ":memory:",
                             &handle,
                             access | SQLITE_OPEN_NOMUTEX,
                             nullptr);
  Db3 out(handle);
  if (code == SQLITE_OK && mapped != nullptr) code = mapped->attach(handle);
  if (code != SQLITE_OK) throw file.error(std::string("cannot be opened: ") + sqlite3_errstr(code));
  // Without this, SQLite rejects truncated files as a whole. The file is opened read-only.
  sqlite3_db_config(handle, SQLITE_DBCONFIG_WRITABLE_SCHEMA, 1, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  return out;
}

Db3Query prepared(const Db3& db, const char* sql) {
  sqlite3_stmt* query = nullptr;
  if (sqlite3_prepare_v2(db.get(), sql, -1, &query, nullptr) != SQLITE_OK) return nullptr;
  return Db3Query(query);
}

std::string text_column(const Db3Query& query, int column) {
  const auto* text = sqlite3_column_text(query.get(), column);
  return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

bool has_tables(const Db3& db) {
  // A view could compute anything, for any time.
  const Db3Query query = prepared(
      db,
      "SELECT count(*) FROM sqlite_master WHERE type='table' AND name IN ('topics','messages')");
  return query && sqlite3_step(query.get()) == SQLITE_ROW &&
         sqlite3_column_int(query.get(), 0) == 2;
}

std::map<std::int64_t, BagTopic> topics_of(const Db3& db) {
  std::map<std::int64_t, BagTopic> out;
  const Db3Query query = prepared(db, "SELECT id, name, type, serialization_format FROM topics");
  while (query && sqlite3_step(query.get()) == SQLITE_ROW) {
    BagTopic topic{text_column(query, 1), text_column(query, 2)};
    topic.encoding = Encoding::cdr;
    if (text_column(query, 3) == "cdr") topic.type = message_type(topic.type_name);
    out[sqlite3_column_int64(query.get(), 0)] = topic;
  }
  return out;
}

/// Bytes that the file's header states but the file does not have; empty if it is complete.
std::string missing_pages(const OpenedFile& file) {
  constexpr std::uint64_t kHeader = 100;
  if (file.size < kHeader) return "ends in its header";
  BagSource source(file);
  ByteReader header(source.bytes(0, kHeader));
  header.set_big_endian(true);
  header.bytes(16);
  const std::uint64_t page = header.number<std::uint16_t>();
  header.bytes(10);
  const std::uint64_t stated = header.number<std::uint32_t>() * (page == 1 ? 65536 : page);
  if (stated <= file.size) return "";
  return fmt::format("{} of {} bytes are missing", stated - file.size, stated);
}

}  // namespace

BagSummary read_db3(const OpenedFile& file, const WantsTopic& wants, const VisitMessage& visit) {
  BagSummary out;
  out.damage = missing_pages(file);
  const auto mapped = file.memory ? std::make_unique<const MappedDb3>(file) : nullptr;
  const Db3 db = open_db3(file, mapped.get());
  if (!has_tables(db)) {
    throw file.error(
        "is an SQLite file without readable tables topics and messages, expected a "
        "ROS 2 bag" +
        (out.damage.empty() ? "" : " (" + out.damage + ")"));
  }
  const std::map<std::int64_t, BagTopic> topics = topics_of(db);
  for (const auto& [id, topic] : topics) add_topic(out, topic);
  const Db3Query query = prepared(db, "SELECT topic_id, data FROM messages ORDER BY id");
  std::size_t read = 0;
  std::size_t damaged = 0;
  int code = SQLITE_CORRUPT;
  while (query && (code = sqlite3_step(query.get())) == SQLITE_ROW) {
    ++read;
    const auto topic = topics.find(sqlite3_column_int64(query.get(), 0));
    if (topic == topics.end() || !wants(topic->second)) continue;
    const auto* data = static_cast<const char*>(sqlite3_column_blob(query.get(), 1));
    const std::string_view bytes(data == nullptr ? "" : data,
                                 static_cast<std::size_t>(sqlite3_column_bytes(query.get(), 1)));
    try {
      if (codec_of(bytes) == Codec::zstd) {
        visit(topic->second, decompress(Codec::zstd, bytes, kMaxMessage));
      } else {
        visit(topic->second, bytes);
      }
    } catch (const DamagedStream&) {
      ++damaged;
    }
  }
  if (damaged > 0) out.add_damage(fmt::format("{} messages are damaged", damaged));
  if (code != SQLITE_DONE) {
    out.add_damage(fmt::format("stops after {} messages: {}", read, sqlite3_errmsg(db.get())));
  }
  return out;
}

}  // namespace loopbench
