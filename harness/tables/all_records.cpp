#include "harness/tables/all_records.hpp"

#include <algorithm>
#include <iterator>

#include "datasets/core/error.hpp"
#include "harness/model/where.hpp"
#include "harness/store/store.hpp"
#include "harness/tables/derived.hpp"
#include "harness/text/suggest.hpp"

namespace loopbench::harness {
namespace {

/// Keeps the scores of one metric: by its label, by the short name of a score ("error x") or, if
/// neither matches, by the metric's name.
void keep_metric(std::vector<Record>& records, const std::string& metric) {
  std::vector<std::string> known;
  for (const char* column : {"label", "score", "metric"}) {
    const auto is_wanted = [&](const Record& r) { return field(r, column) == metric; };
    for (const Record& r : records) {
      if (r.metric.empty() || std::ranges::count(known, field(r, column)) > 0) continue;
      known.push_back(field(r, column));
    }
    if (std::ranges::none_of(records, is_wanted)) continue;
    std::erase_if(records, [&](const Record& r) { return !r.metric.empty() && !is_wanted(r); });
    return;
  }
  throw InputError("--metric: " + unknown_name("metric", metric, known));
}

}  // namespace

std::vector<Record> all_records(const std::filesystem::path& store) {
  std::vector<Record> records = read_records(store);
  const auto run = read_run(store);
  std::vector<Record> gain = gains(records, run.at("baseline"));
  std::vector<Record> pairs = pair_counts(records);
  std::vector<Record> time = run_times(records);
  for (std::vector<Record>* more : {&gain, &pairs, &time}) {
    records.insert(
        records.end(), std::move_iterator(more->begin()), std::move_iterator(more->end()));
  }
  return records;
}

std::vector<Comparison> compare_store(const std::filesystem::path& store,
                                      const std::string& metric,
                                      const std::vector<std::string>& rules,
                                      CompareOptions options) {
  std::vector<Record> records = all_records(store);
  keep_where(records, rules);
  if (std::ranges::all_of(records, [](const Record& r) { return r.metric.empty(); })) {
    throw InputError(store.string() + ": no score to compare" +
                     (rules.empty() ? "" : " after --where"));
  }
  keep_metric(records, metric);
  if (options.baseline.empty()) options.baseline = read_run(store).at("baseline");
  if (options.baseline.empty()) {
    throw InputError(store.string() + ": the sweep has no baseline; set --baseline METHOD");
  }
  return compare(records, options);
}

}  // namespace loopbench::harness
