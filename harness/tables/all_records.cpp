#include "harness/tables/all_records.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "datasets/core/error.hpp"
#include "harness/base/suggest.hpp"
#include "harness/compare/derived.hpp"
#include "harness/model/name_order.hpp"
#include "harness/model/where.hpp"
#include "harness/store/read.hpp"
#include "harness/store/record_reader.hpp"

namespace loopbench::harness {
namespace {

void for_each_with_derived(RecordReader& reader,
                           const std::string& baseline,
                           const std::function<void(const Record&)>& visit) {
  reader.for_each_chunk([&](std::vector<Record>& records) {
    add_derived(records, baseline);
    std::ranges::for_each(records, visit);
    return true;
  });
}

/// Records of the scores of a store, of a cell without a name.
std::vector<Record> stored_kinds(const RecordReader& reader) {
  Record any;
  any.cell.edit().runs = 1;  // so that it has a time
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

}  // namespace

void for_each_record(const std::filesystem::path& store,
                     const std::function<void(const Record&)>& visit) {
  RecordReader reader(store);
  for_each_with_derived(reader, read_run(store).at("baseline"), visit);
}

std::vector<Record> all_records(const std::filesystem::path& store) {
  std::vector<Record> out;
  for_each_record(store, [&](const Record& r) { out.push_back(r); });
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
  add_derived(definitions, "");  // of any method: definitions have none
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
  is_derived ? for_each_with_derived(reader, baseline, add) : reader.for_each(add);
  std::vector<Observations> all = wanted.build();
  if (all.empty()) throw InputError(nothing);
  return compare(std::move(all), options);
}

}  // namespace loopbench::harness
