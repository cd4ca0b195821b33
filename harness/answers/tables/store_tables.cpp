#include "harness/answers/tables/store_tables.hpp"

#include <algorithm>
#include <atomic>
#include <deque>
#include <future>
#include <iterator>
#include <set>
#include <thread>
#include <utility>

#include "datasets/core/error.hpp"
#include "harness/answers/compare/derived.hpp"
#include "harness/answers/tables/reasons.hpp"
#include "harness/sweep/model/name_order.hpp"
#include "harness/sweep/model/where.hpp"
#include "harness/sweep/store/read.hpp"
#include "harness/sweep/text/suggest.hpp"

namespace loopbench::harness {
namespace {

void for_each_with_derived(RecordReader& reader,
                           const std::string& baseline,
                           const std::vector<std::string>& asked,
                           const std::function<void(const Record&)>& visit) {
  reader.for_each_chunk([&](std::vector<Record>& records) {
    add_derived(records, baseline, asked);
    std::ranges::for_each(records, visit);
    return true;
  });
}

/// Records of the scores of a store, of a cell without a name.
std::vector<Record> stored_kinds(const RecordReader& reader) {
  Record any;
  CellRow& cell = any.cell.edit();
  cell.runs = 1;  // so that it has costs
  cell.cpu_seconds = 0.0;
  cell.peak_memory = 0;
  std::vector<Record> out;
  for (const Shared<ScoreKind>& kind : reader.kinds()) out.emplace_back(any).kind = kind;
  return out;
}

/// How a record can match --metric, the most specific first.
constexpr const char* kMetricFields[] = {"label", "score", "metric"};

/// The first of kMetricFields in which a definition has this text; throws InputError if none has.
const char* matching_field(const std::vector<Record>& definitions, const std::string& metric) {
  NameOrder known;
  for (const char* name : kMetricFields) {
    for (const Record& r : definitions) {
      const std::string text = field(r, name);
      if (text == metric) return name;
      known.index(text);
    }
  }
  throw InputError("--metric: " + unknown_name("metric", metric, known.names()));
}

[[noreturn]] void reject_empty(const std::filesystem::path& store,
                               const std::vector<std::string>& rules) {
  throw InputError(store.string() + (rules.empty() ? ": has no rows" : ": no row matches --where"));
}

/// Keeps one kind of times; returns its name if there were several.
std::string keep_one_time(std::vector<Record>& records) {
  std::vector<std::string> times;
  for (const Record& r : records) {
    if (r.has_score() && std::ranges::count(times, r.kind->times) == 0)
      times.push_back(r.kind->times);
  }
  if (times.size() < 2) return "";
  const std::string kept = std::ranges::count(times, "dense") > 0 ? "dense" : times.front();
  std::erase_if(records, [&](const Record& r) { return r.has_score() && r.kind->times != kept; });
  return kept;
}

/// Keeps the first score that is shown; returns its name.
std::string keep_one_score(std::vector<Record>& records, const std::vector<std::string>& show) {
  const auto is_shown = [&](const Record& r) {
    return r.has_score() && (show.empty() || std::ranges::count(show, r.kind->short_name()) > 0);
  };
  const auto first = std::ranges::find_if(records, is_shown);
  if (first == records.end()) return "";
  const Record kept = *first;
  std::erase_if(records, [&](const Record& r) {
    return r.has_score() &&
           (r.kind->metric_label() != kept.kind->metric_label() ||
            r.kind->relation != kept.kind->relation || r.kind->axis != kept.kind->axis);
  });
  return kept.kind->short_name();
}

/// Removes the records that lack an option of the layout, unless all do; returns their methods.
std::string keep_with_options(std::vector<Record>& records, const TableSpec& spec) {
  const auto lacks_one = [&](const Record& r) {
    const auto is_lacking = [&](const std::string& name) { return !has_field(r, name); };
    return std::ranges::any_of(spec.rows, is_lacking) ||
           std::ranges::any_of(spec.columns, is_lacking);
  };
  if (!is_by_option(spec) || std::ranges::all_of(records, lacks_one)) return "";
  NameOrder methods;
  for (const Record& r : records) {
    if (lacks_one(r)) methods.index(r.cell->method);
  }
  std::erase_if(records, lacks_one);
  return listed(methods.names());
}

/// Layouts such as `--split ''` or `--rows sequence` leave open which times and scores a cell
/// contains. Keeps dense times (without any: the first) if the layout does not separate times;
/// makes methods the columns if the layout does not contain them, and then keeps the first shown
/// score. Returns a note about what is shown; empty if nothing was selected. O(n).
TableNote complete_layout(std::vector<Record>& records, TableSpec& spec) {
  std::string score;
  const std::string without = keep_with_options(records, spec);
  if (!separates(spec, {"method"})) {
    if (!is_by_option(spec)) spec.columns = {"method"};
    std::erase(spec.split, "sequence");
    std::erase(spec.split, "times");
    if (!separates(spec, {"score", "metric", "label"})) score = keep_one_score(records, spec.show);
  }
  const std::string times = separates(spec, {"times"}) ? "" : keep_one_time(records);
  TableNote out("", "");
  const auto add = [&out](const std::string& what, const std::string& option) {
    const char* const separator = out.text.empty() ? "" : "; ";
    out.text += separator + what + option;
    *out.in_paper += separator + what;
  };
  if (!score.empty()) add("score: " + score, " (others: --show)");
  if (!times.empty()) add("times: " + times, " (others: --where times=...)");
  if (!without.empty()) add("left out, without option: " + without, "");
  return out;
}

bool is_by_sequence(const TableSpec& spec) {
  return std::ranges::count(spec.split, "sequence") > 0 && separates(spec, {"method"}) &&
         separates(spec, {"times"});
}

/// Whether the records that pass have more than one protocol.
bool has_protocols(const RecordReader& reader,
                   const std::filesystem::path& store,
                   const std::function<bool(const Record&)>& is_kept) {
  std::set<std::string> protocols;
  for (const Shared<ScoreKind>& kind : reader.kinds()) protocols.insert(kind->protocol);
  if (protocols.size() < 2) return false;
  protocols.clear();
  for_each_record(store, [&](const Record& r) {
    if (r.has_score() && is_kept(r)) protocols.insert(r.kind->protocol);
  });
  return protocols.size() > 1;
}

std::vector<Table> tables_by_sequence(const std::filesystem::path& store,
                                      const std::vector<std::string>& rules,
                                      TableSpec spec) {
  const std::string baseline = read_run(store).at("baseline");
  const auto is_kept = where(rules);
  RecordReader reader(store);
  if (!separates(spec, {"protocol"}) && has_protocols(reader, store, is_kept)) {
    spec.split.emplace_back("protocol");
  }
  std::vector<Table> out;
  std::vector<Table> without_scores;  // after the others, as in pivot()
  std::atomic<bool> has_records = false;
  std::deque<std::future<std::vector<Table>>> begun;
  const auto take_first = [&] {
    for (Table& table : begun.front().get()) {
      (table.has_scores ? out : without_scores).push_back(std::move(table));
    }
    begun.pop_front();
  };
  // More than processors, because the first is waited for while others may have ended.
  const std::size_t most = std::max(1u, std::thread::hardware_concurrency()) + 2;
  reader.for_each_chunk([&](std::vector<Record>& records) {
    if (begun.size() >= most) take_first();
    begun.push_back(std::async(std::launch::async, [&, own = std::move(records)]() mutable {
      add_derived(own, baseline, asked_by(spec, rules));
      if (!rules.empty()) std::erase_if(own, [&](const Record& r) { return !is_kept(r); });
      if (own.empty()) return std::vector<Table>{};
      has_records = true;
      return pivot_parts(own, spec);
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

void for_each_record(const std::filesystem::path& store,
                     const std::function<void(const Record&)>& visit,
                     const std::vector<std::string>& asked) {
  RecordReader reader(store);
  for_each_with_derived(reader, read_run(store).at("baseline"), asked, visit);
}

std::vector<Record> all_records(const std::filesystem::path& store,
                                const std::vector<std::string>& asked) {
  std::vector<Record> out;
  for_each_record(
      store, [&](const Record& r) { out.push_back(r); }, asked);
  return out;
}

std::vector<Comparison> compare_store(const std::filesystem::path& store,
                                      const std::string& metric,
                                      const std::vector<std::string>& rules,
                                      CompareOptions options) {
  const std::string baseline = read_run(store).at("baseline");
  if (options.baseline.empty()) options.baseline = baseline;
  if (options.baseline.empty()) {
    throw InputError(store.string() + ": the sweep has no baseline; set --baseline METHOD");
  }
  const std::string nothing =
      store.string() + ": no score to compare" + (rules.empty() ? "" : " after --where");
  RecordReader reader(store);
  const std::vector<Record> stored = stored_kinds(reader);
  if (stored.empty()) throw InputError(nothing);
  std::vector<Record> definitions = stored;
  std::vector<std::string> asked = rules;
  asked.push_back(metric);
  add_derived(definitions, "", asked);  // of any method: definitions have none
  const char* const name = metric.empty() ? nullptr : matching_field(definitions, metric);
  const auto is_wanted = [&](const Record& r) { return !name || field(r, name) == metric; };
  std::set<ScoreKind> kept;
  for (const Record& r : stored) {
    if (is_wanted(r)) kept.insert(*r.kind);
  }
  const bool is_derived =
      std::any_of(definitions.begin() + static_cast<std::ptrdiff_t>(stored.size()),
                  definitions.end(),
                  [&](const Record& r) { return name && is_wanted(r); });
  if (!is_derived) {
    reader.keep_scores([kept](const ScoreKind& kind) { return kept.contains(kind); });
  }
  const auto passes = where(rules);
  ObservationsBuilder wanted(options.value);
  const auto add = [&](const Record& r) {
    if (passes(r) && (!r.has_score() || is_wanted(r))) wanted.add(r);
  };
  is_derived ? for_each_with_derived(reader, baseline, asked, add) : reader.for_each(add);
  std::vector<Observations> all = wanted.build();
  if (all.empty()) throw InputError(nothing);
  return compare(std::move(all), options);
}

std::vector<Table> store_tables(const std::filesystem::path& store,
                                const std::vector<std::string>& rules,
                                TableSpec spec) {
  for (auto* names : {&spec.rows, &spec.columns, &spec.split}) std::erase(*names, "");
  if (is_by_sequence(spec)) return tables_by_sequence(store, rules, spec);
  std::vector<Record> records = all_records(store, asked_by(spec, rules));
  keep_where(records, rules);
  if (records.empty()) reject_empty(store, rules);
  const TableNote note = complete_layout(records, spec);
  std::vector<Table> tables = pivot(records, spec);
  for (Table& table : tables) {
    if (!note.text.empty()) table.notes.insert(table.notes.begin(), note);
  }
  return tables;
}

}  // namespace loopbench::harness
