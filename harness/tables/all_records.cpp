#include "harness/tables/all_records.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "datasets/core/error.hpp"
#include "harness/base/suggest.hpp"
#include "harness/compare/derived.hpp"
#include "harness/compare/name_order.hpp"
#include "harness/model/where.hpp"
#include "harness/store/read.hpp"

namespace loopbench::harness {
namespace {

/// How a record can match --metric, the most specific first.
constexpr const char* kMetricFields[] = {"label", "score", "metric"};
constexpr std::size_t kNoField = std::size(kMetricFields);

/// Whether a derived record can match.
bool can_be_derived(const std::string& metric) {
  return metric.starts_with("gain") || metric.starts_with("pairs") || metric.starts_with("time");
}

/// The records of all_records() that pass a filter.
class FilteredRecords {
 public:
  FilteredRecords(const std::filesystem::path& store, const std::vector<std::string>& rules)
      : reader_(store), baseline_(read_run(store).at("baseline")), is_kept_(where(rules)) {}

  void for_each(bool derived, const std::function<bool(const Record&)>& visit) {
    for_each_record(
        reader_, baseline_, derived, [&](const Record& r) { return !is_kept_(r) || visit(r); });
  }

  /// Restricts for_each(false, ...) to metrics of which a score has this text in the field.
  void keep_metrics(const std::string& metric, std::size_t own) {
    std::set<std::pair<SharedText, SharedText>> kept;  // metric and label
    reader_.for_each_definition([&](const Record& r) {
      if (metric.empty() || field(r, kMetricFields[own]) == metric) kept.emplace(r.metric, r.label);
    });
    reader_.keep_scores([kept](const Record& r) { return kept.contains({r.metric, r.label}); });
  }

  /// The first of kMetricFields in which a record has this text, "" in all; kNoField if none has.
  std::size_t field_of(const std::string& metric, bool derived) {
    std::size_t found = kNoField;
    for_each(derived, [&](const Record& r) {
      for (std::size_t f = 0; f < found && !r.metric.empty(); ++f) {
        if (metric.empty() || field(r, kMetricFields[f]) == metric) found = f;
      }
      return found > 0;
    });
    return found;
  }

  /// Throws InputError with the metrics that there are.
  [[noreturn]] void reject(const std::string& metric, const std::string& none) {
    NameOrder known[kNoField];
    bool has_score = false;
    for_each(true, [&](const Record& r) {
      if (r.metric.empty()) return true;
      has_score = true;
      for (std::size_t f = 0; f < kNoField; ++f) known[f].index(field(r, kMetricFields[f]));
      return true;
    });
    if (!has_score) throw InputError(none);
    NameOrder all;
    for (const NameOrder& of_field : known) {
      for (const std::string& name : of_field.names()) all.index(name);
    }
    if (metric.empty()) throw InputError(none);
    throw InputError("--metric: " + unknown_name("metric", metric, all.names()));
  }

 private:
  RecordReader reader_;
  std::string baseline_;
  std::function<bool(const Record&)> is_kept_;
};

}  // namespace

std::vector<Record> all_records(const std::filesystem::path& store) {
  std::vector<Record> records = read_records(store);
  add_derived(records, read_run(store).at("baseline"));
  return records;
}

void for_each_record(RecordReader& reader,
                     const std::string& baseline,
                     bool derived,
                     const std::function<bool(const Record&)>& visit) {
  using Derive = std::function<std::vector<Record>(const std::vector<Record>&)>;
  const Derive parts[] = {{},
                          [&](const auto& records) { return gains(records, baseline); },
                          [](const auto& records) { return pair_counts(records); },
                          [](const auto& records) { return run_times(records); }};
  bool goes_on = true;
  for (const Derive& derive : parts) {
    if (!goes_on || (derive && !derived)) return;
    reader.for_each_chunk([&](std::vector<Record>& records) {
      if (derive) records = derive(records);
      goes_on = std::ranges::all_of(records, visit);
      return goes_on;
    });
  }
}

std::vector<Comparison> compare_store(const std::filesystem::path& store,
                                      const std::string& metric,
                                      const std::vector<std::string>& rules,
                                      CompareOptions options) {
  FilteredRecords all(store, rules);
  const bool derived = can_be_derived(metric);
  const std::size_t own = all.field_of(metric, derived);
  if (own == kNoField) {
    all.reject(metric,
               store.string() + ": no score to compare" + (rules.empty() ? "" : " after --where"));
  }
  if (options.baseline.empty()) options.baseline = read_run(store).at("baseline");
  if (options.baseline.empty()) {
    throw InputError(store.string() + ": the sweep has no baseline; set --baseline METHOD");
  }
  if (!derived) all.keep_metrics(metric, own);
  const RecordSource wanted = [&](const auto& visit) {
    all.for_each(derived, [&](const Record& r) {
      if (r.metric.empty() || metric.empty() || field(r, kMetricFields[own]) == metric) visit(r);
      return true;
    });
  };
  return compare(wanted, options);
}

}  // namespace loopbench::harness
