#include "harness/store/score_lists.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "harness/text/hash.hpp"

namespace loopbench::harness {
namespace {

static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(double) == 8);

constexpr const char* kListTables[] = {"score_list", "score_list_copy"};
constexpr const char* kListColumns =
    "list, number, protocol, protocol_version, times, metric, label, relation, axis, unit, better, "
    "target";

void pack_number(double value, std::string& bytes) {
  const std::uint64_t big = __builtin_bswap64(std::bit_cast<std::uint64_t>(value + 0.0));
  char raw[8];
  std::memcpy(raw, &big, sizeof raw);
  bytes.append(raw, sizeof raw);
}

double unpacked_number(const char* raw) {
  std::uint64_t big = 0;
  std::memcpy(&big, raw, sizeof big);
  return std::bit_cast<double>(__builtin_bswap64(big));
}

/// All texts of a definition, in the order of the columns.
template <class Definition>
auto texts_of(Definition& d) {
  return std::array{&d.protocol,
                    &d.protocol_version,
                    &d.times,
                    &d.metric,
                    &d.label,
                    &d.relation,
                    &d.axis,
                    &d.unit,
                    &d.better};
}

/// The lists of one table whose key matches; clears `intact` at any other.
ScoreListMap intact_lists(Database& database, const std::string& table, bool& intact) {
  ScoreListMap out;
  Statement row = database.prepare(std::string("SELECT ") + kListColumns + " FROM " + table +
                                   " ORDER BY list, number");
  while (row.step()) {
    const std::string key = row.text();
    ScoreList& list = out[key];
    const std::int64_t number = row.integer();
    if (number != static_cast<std::int64_t>(list.size())) intact = false;
    ScoreDefinition& d = list.emplace_back();
    for (SharedText* text : texts_of(d)) {
      *text = row.view();
    }
    d.target = row.real();
  }
  const auto removed =
      std::erase_if(out, [](const auto& entry) { return key_of(entry.second) != entry.first; });
  if (removed > 0) intact = false;
  return out;
}

}  // namespace

std::string key_of(const ScoreList& list) {
  Fields fields;
  for (const ScoreDefinition& d : list) {
    for (const SharedText* text : texts_of(d)) fields.add(text->text());
    fields.add(std::to_string(std::bit_cast<std::uint64_t>(d.target + 0.0)));
  }
  return fields.hashed();
}

ScoreLists::ScoreLists(Database& database, const std::string& schema) {
  lists_ = intact_lists(database, schema + kListTables[0], intact_);
  ScoreListMap copy = intact_lists(database, schema + kListTables[1], intact_);
  if (copy != lists_) intact_ = false;
  lists_.merge(copy);
}

const ScoreList* ScoreLists::find(std::string_view key) const {
  const auto found = lists_.find(key);
  return found == lists_.end() ? nullptr : &found->second;
}

void write_list(Database& database, const std::string& key, const ScoreList& list) {
  for (const char* table : kListTables) {
    Statement insert = database.prepare(std::string("INSERT OR REPLACE INTO main.") + table + " (" +
                                        kListColumns + ") VALUES (?,?,?,?,?,?,?,?,?,?,?,?)");
    std::int64_t number = 0;
    for (const ScoreDefinition& d : list) {
      insert.bind(key).bind(number++);
      for (const SharedText* text : texts_of(d)) {
        insert.bind(text->text());
      }
      insert.bind(d.target).run();
    }
  }
}

void rewrite_lists(Database& database, const ScoreLists& lists) {
  for (const char* table : kListTables) database.execute(std::string("DELETE FROM ") + table);
  for (const auto& [key, list] : lists.all()) write_list(database, key, list);
}

void pack(const ScoreNumbers& numbers, std::string& bytes) {
  const metrics::Statistics& s = numbers.statistics;
  for (const double value : {static_cast<double>(s.count),
                             s.rmse,
                             s.mean,
                             s.median,
                             s.std,
                             s.min,
                             s.max,
                             s.sse,
                             static_cast<double>(numbers.pairs),
                             static_cast<double>(numbers.possible),
                             numbers.span}) {
    pack_number(value, bytes);
  }
}

ScoreNumbers unpacked(std::string_view bytes, std::size_t index) {
  const char* raw = bytes.data() + index * kPackedScore;
  double values[11];
  for (std::size_t i = 0; i < 11; ++i) values[i] = unpacked_number(raw + 8 * i);
  ScoreNumbers out;
  out.statistics = {static_cast<std::size_t>(values[0]),
                    values[1],
                    values[2],
                    values[3],
                    values[4],
                    values[5],
                    values[6],
                    values[7]};
  out.pairs = static_cast<std::int64_t>(values[8]);
  out.possible = static_cast<std::int64_t>(values[9]);
  out.span = values[10];
  return out;
}

const ScoreList* list_of(const ScoreLists& lists, std::string_view key, std::string_view numbers) {
  const ScoreList* list = lists.find(key);
  return list != nullptr && numbers.size() == kPackedScore * list->size() ? list : nullptr;
}

std::string joined_statuses(const std::vector<std::string>& statuses_and_reasons) {
  bool all_ok = true;
  std::string out;
  for (std::size_t i = 0; i < statuses_and_reasons.size(); ++i) {
    std::string text = statuses_and_reasons[i];
    all_ok = all_ok && text == (i % 2 == 0 ? "ok" : "");
    std::ranges::replace(text, kStatusSeparator, ' ');
    if (i > 0) out += kStatusSeparator;
    out += text;
  }
  return all_ok ? "" : out;
}

std::vector<std::string> split_statuses(std::string_view statuses, std::size_t scores) {
  std::vector<std::string> out;
  while (!statuses.empty()) {
    const std::size_t end = statuses.find(kStatusSeparator);
    out.emplace_back(statuses.substr(0, end));
    if (end == std::string_view::npos) break;
    statuses.remove_prefix(end + 1);
    if (statuses.empty()) out.emplace_back();
  }
  for (std::size_t i = out.size(); i < 2 * scores; ++i) out.emplace_back(i % 2 == 0 ? "ok" : "");
  return out;
}

}  // namespace loopbench::harness
