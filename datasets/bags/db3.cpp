// ROS 2 bag in SQLite: tables topics(id, name, type, ...) and messages(id, topic_id, timestamp,
// data). Messages can be compressed one by one (compression_mode: message).
#include <fmt/format.h>

#include <map>

#include "datasets/bags/messages.hpp"
#include "datasets/bags/sqlite_file.hpp"
#include "datasets/compressed/decompress.hpp"

namespace loopbench {
namespace {

constexpr std::size_t kMaxMessage = std::size_t{1} << 30;  // [bytes]

std::map<std::int64_t, BagTopic> topics_of(const SqliteFile& db) {
  std::map<std::int64_t, BagTopic> out;
  const SqliteQuery query = prepared(db, "SELECT id, name, type, serialization_format FROM topics");
  while (step(query) == SqliteStep::row) {
    BagTopic topic{std::string(text(query, 1)), std::string(text(query, 2))};
    topic.encoding = Encoding::cdr;
    if (text(query, 3) == "cdr") topic.type = message_type(topic.type_name);
    out[integer(query, 0)] = topic;
  }
  return out;
}

}  // namespace

BagSummary read_db3(const OpenedFile& file, const WantsTopic& wants, const VisitMessage& visit) {
  BagSummary out;
  const SqliteFile db = open_sqlite(file);
  if (has_tables(db, {"Node", "Link"})) {
    throw file.error(
        "is a database of RTAB-Map, expected its export: rtabmap-export --poses --poses_format 10 "
        "FILE (rows of TUM with the id of the node), or --poses_format 4 (g2o with the closures)");
  }
  if (!has_tables(db, {"topics", "messages"})) {
    throw file.error(
        "is an SQLite file without readable tables topics and messages, expected a ROS 2 bag");
  }
  const std::map<std::int64_t, BagTopic> topics = topics_of(db);
  for (const auto& [id, topic] : topics) add_topic(out, topic);
  const SqliteQuery query = prepared(db, "SELECT topic_id, data FROM messages ORDER BY id");
  std::size_t read = 0;
  std::size_t damaged = 0;
  SqliteStep last = SqliteStep::failed;
  while ((last = step(query)) == SqliteStep::row) {
    ++read;
    const auto topic = topics.find(integer(query, 0));
    if (topic == topics.end() || !wants(topic->second)) continue;
    const std::string_view bytes = blob(query, 1);
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
  if (last == SqliteStep::failed) {
    out.add_damage(fmt::format("stops after {} messages: {}", read, last_error(db)));
  }
  return out;
}

}  // namespace loopbench
