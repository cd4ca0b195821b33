#include "harness/tables/store_tables.hpp"

#include <algorithm>
#include <atomic>
#include <deque>
#include <future>
#include <iterator>
#include <optional>
#include <thread>

#include "datasets/core/error.hpp"
#include "harness/compare/derived.hpp"
#include "harness/model/where.hpp"
#include "harness/store/read.hpp"
#include "harness/tables/all_records.hpp"
#include "harness/tables/usual_table.hpp"

namespace loopbench::harness {
namespace {

[[noreturn]] void reject_empty(const std::filesystem::path& store,
                               const std::vector<std::string>& rules) {
  throw InputError(store.string() + (rules.empty() ? ": has no rows" : ": no row matches --where"));
}

bool is_by_sequence(const TableSpec& spec) {
  return std::ranges::count(spec.split, "sequence") > 0 && separates(spec, {"method"}) &&
         separates(spec, {"times"});
}

/// Whether the records that pass have more than one protocol.
bool has_protocols(RecordReader& reader,
                   const std::string& baseline,
                   const std::function<bool(const Record&)>& is_kept) {
  if (!reader.has_several_protocols()) return false;
  std::optional<std::string> first;
  bool found = false;
  for_each_record(reader, baseline, true, [&](const Record& r) {
    if (r.metric.empty() || !is_kept(r)) return true;
    if (!first) first = r.protocol;
    found = r.protocol != *first;
    return !found;
  });
  return found;
}

std::vector<Table> tables_by_sequence(const std::filesystem::path& store,
                                      const std::vector<std::string>& rules,
                                      TableSpec spec,
                                      const RankingOptions& options) {
  const std::string baseline = read_run(store).at("baseline");
  const auto is_kept = where(rules);
  RecordReader reader(store);
  if (!separates(spec, {"protocol"}) && has_protocols(reader, baseline, is_kept)) {
    spec.split.emplace_back("protocol");
  }
  std::vector<Table> out;
  std::vector<Table> without_scores;  // after the others, as in pivot()
  std::atomic<bool> has_records = false;
  std::deque<std::future<PivotedTables>> begun;
  const auto take_first = [&] {
    PivotedTables own = begun.front().get();
    begun.pop_front();
    const auto middle = own.tables.begin() + static_cast<std::ptrdiff_t>(own.with_scores);
    std::move(own.tables.begin(), middle, std::back_inserter(out));
    std::move(middle, own.tables.end(), std::back_inserter(without_scores));
  };
  // More than processors, because the first is waited for while others may have ended.
  const std::size_t most = std::max(1u, std::thread::hardware_concurrency()) + 2;
  reader.for_each_chunk([&](std::vector<Record>& records) {
    if (begun.size() >= most) take_first();
    begun.push_back(std::async(std::launch::async, [&, own = std::move(records)]() mutable {
      add_derived(own, baseline);
      if (!rules.empty()) std::erase_if(own, [&](const Record& r) { return !is_kept(r); });
      if (own.empty()) return PivotedTables{};
      has_records = true;
      return pivot_parts(own, spec, options);
    }));
    records = {};
    return true;
  });
  while (!begun.empty()) take_first();
  std::ranges::move(without_scores, std::back_inserter(out));
  if (!has_records) reject_empty(store, rules);
  if (out.empty()) throw InputError(kEmptyTable);
  return out;
}

}  // namespace

std::vector<Table> store_tables(const std::filesystem::path& store,
                                const std::vector<std::string>& rules,
                                TableSpec spec,
                                const RankingOptions& options) {
  for (auto* names : {&spec.rows, &spec.columns, &spec.split}) std::erase(*names, "");
  if (is_by_sequence(spec)) return tables_by_sequence(store, rules, spec, options);
  std::vector<Record> records = all_records(store);
  keep_where(records, rules);
  if (records.empty()) reject_empty(store, rules);
  const std::string note = make_usual(records, spec);
  std::vector<Table> tables = pivot(records, spec, options);
  for (Table& table : tables) {
    if (!note.empty()) table.notes.insert(table.notes.begin(), note);
  }
  return tables;
}

}  // namespace loopbench::harness
