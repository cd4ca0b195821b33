// ROS 2 bag in SQLite: tables topics(id, name, type, ...) and messages(id, topic_id, timestamp,
// data). Messages can be compressed one by one (compression_mode: message).
#include <fmt/format.h>
#include <sqlite3.h>

#include <fstream>
#include <map>
#include <memory>

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

/// Replaces the empty database of `db` by a file in memory, which has no path that SQLite can open:
/// it was decompressed, or read from a pipe.
int load_into(sqlite3* db, const OpenedFile& file) {
  auto* const bytes = static_cast<unsigned char*>(sqlite3_malloc64(file.size));
  if (bytes == nullptr) return SQLITE_NOMEM;
  std::ifstream in(file.path, std::ios::binary);
  if (!in.read(reinterpret_cast<char*>(bytes), static_cast<std::streamsize>(file.size))) {
    sqlite3_free(bytes);
    return SQLITE_IOERR_READ;
  }
  // SQLite rejects a database in memory that has a write-ahead log, which is a second file.
  constexpr std::size_t kWriteVersion = 18, kReadVersion = 19;
  if (file.size > kReadVersion) bytes[kWriteVersion] = bytes[kReadVersion] = 1;
  const auto size = static_cast<sqlite3_int64>(file.size);
  constexpr unsigned kFlags = SQLITE_DESERIALIZE_READONLY | SQLITE_DESERIALIZE_FREEONCLOSE;
  return sqlite3_deserialize(db, "main", bytes, size, size, kFlags);
}

Db3 open_db3(const OpenedFile& file) {
  const bool in_memory = file.memory != nullptr;
  sqlite3* handle = nullptr;
  int code =
      sqlite3_open_v2(in_memory ? ":memory:" : uri_of(file.path).c_str(),
                      &handle,
                      SQLITE_OPEN_NOMUTEX | (in_memory ? SQLITE_OPEN_READWRITE
                                                       : SQLITE_OPEN_READONLY | SQLITE_OPEN_URI),
                      nullptr);
  Db3 out(handle);
  if (code == SQLITE_OK && in_memory) code = load_into(handle, file);
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

}  // namespace

BagSummary read_db3(const OpenedFile& file, const WantsTopic& wants, const VisitMessage& visit) {
  BagSummary out;
  const Db3 db = open_db3(file);
  if (!has_tables(db)) {
    throw file.error(
        "is an SQLite file without readable tables topics and messages, expected a ROS 2 bag");
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
