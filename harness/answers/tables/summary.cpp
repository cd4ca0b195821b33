#include "harness/answers/tables/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "harness/answers/compare/stated.hpp"
#include "harness/answers/tables/comparison.hpp"
#include "harness/answers/tables/pivot.hpp"
#include "harness/answers/tables/reasons.hpp"
#include "harness/sweep/text/counted.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostSequences = 12;
constexpr std::size_t kMostMethods = 16;
constexpr std::size_t kMostReasons = 5;

bool is_derived(const Record& r) {
  return sign_of_ratio(r.kind->metric) != 0 || r.kind->metric == "pairs" ||
         r.kind->metric == "time";
}

/// The records that can lead the summary, and those of cells without scores: one protocol, one kind
/// of times, with a direction.
std::vector<Record> comparable(const std::vector<Record>& records, const SummaryOptions& options) {
  std::vector<Record> out = records;
  std::erase_if(out, [](const Record& r) {
    return r.has_score() && (is_derived(r) || r.kind->better == metrics::Better::neither);
  });
  // Keeps the scores that pass, if any does.
  const auto keep = [&](const auto& passes) {
    const auto is_kept = [&](const Record& r) { return r.has_score() && passes(r); };
    if (std::ranges::none_of(out, is_kept)) return;
    std::erase_if(out, [&](const Record& r) { return r.has_score() && !passes(r); });
  };
  const auto first = std::ranges::find_if(out, [](const Record& r) { return r.has_score(); });
  if (first == out.end()) return {};
  const Record lead = *first;
  keep([](const Record& r) { return r.kind->times == "dense"; });
  keep([&](const Record& r) { return r.kind->times == lead.kind->times; });
  keep([&](const Record& r) { return r.kind->protocol == lead.kind->protocol; });
  keep([&](const Record& r) {
    return options.show.empty() || std::ranges::count(options.show, r.kind->short_name()) > 0;
  });
  return out;
}

/// Why methods have no value, grouped.
std::vector<std::string> reasons(const std::vector<Record>& records) {
  std::vector<Missing> missing;
  for (const Record& r : records) {
    if (r.status == Status::ok) continue;
    missing.push_back({r.cell->method, r.kind->metric_label(), to_text(r.status), r.why});
  }
  std::vector<std::string> out = grouped(missing);
  if (out.size() > kMostReasons) {
    const std::size_t more = out.size() - kMostReasons;
    out.resize(kMostReasons);
    out.push_back(fmt::format("{} more reasons: see table", more));
  }
  return out;
}

/// The leading score in translation and rotation, the first relative one, and the CPU times.
std::vector<Record> shown(const std::vector<Record>& records,
                          const std::vector<Record>& candidates,
                          const Record& lead) {
  const std::string name = lead.kind->short_name();
  const auto relative = std::ranges::find_if(candidates, [&](const Record& r) {
    return r.has_score() && r.kind->metric == "rpe" && r.kind->short_name() != name;
  });
  std::vector<Record> out;
  for (const Record& r : candidates) {
    const bool is_relative = relative != candidates.end() && r.kind == relative->kind;
    if (!r.has_score() || r.kind->short_name() == name || is_relative) out.push_back(r);
  }
  const auto is_time = [&](const Record& r) {
    return r.status == Status::ok && r.kind->metric == "time" &&
           r.kind->times == lead.kind->times && r.kind->protocol == lead.kind->protocol;
  };
  Shared<ScoreKind> cpu;
  for (const Record& r : records) {
    if (!is_time(r)) continue;
    out.push_back(r);
    if (!r.cell->cpu_seconds) continue;
    if (cpu->label.empty()) (cpu = r.kind).edit().label = "cpu";
    out.back().kind = cpu;
    if (!r.cell->is_stated()) out.back().statistics.rmse = 1e3 * *r.cell->cpu_seconds;
  }
  return out;
}

/// The order of the comparison; the last rows are left out, but not the baseline.
void sort_lines(Table& out, const Comparison& c) {
  const auto place = [&](const auto& line) {
    return std::ranges::find(c.methods, line[0].text, &MethodVerdict::method) - c.methods.begin();
  };
  std::ranges::stable_sort(out.lines, {}, place);
  if (out.lines.size() <= kMostMethods) return;
  const auto baseline = std::ranges::find_if(
      out.lines, [&](const auto& line) { return line[0].text == c.options.baseline; });
  const auto last = out.lines.begin() + (kMostMethods - 1);
  if (baseline != out.lines.end() && baseline > last) std::iter_swap(last, baseline);
}

}  // namespace

std::vector<Table> summary(const std::vector<Record>& records,
                           const SummaryOptions& options,
                           std::set<std::string>* stated) {
  const std::vector<Record> candidates = comparable(records, options);
  const auto lead = std::ranges::find_if(candidates, [](const Record& r) { return r.has_score(); });
  if (lead == candidates.end()) return {};
  const std::vector<Record> own = shown(records, candidates, *lead);
  std::set<std::string> sequences, oracle_sequences;
  std::vector<Record> compared;
  bool has_baseline = false;
  for (const Record& r : own) {
    sequences.insert(r.cell->sequence);
    if (r.cell->oracle_closures) oracle_sequences.insert(r.cell->sequence);
    has_baseline = has_baseline || r.cell->method == options.baseline;  // `run --only` can lack it
    if (!r.has_score() || r.kind->short_name() == lead->kind->short_name()) compared.push_back(r);
  }
  const TableSpec spec{
      .columns = {"score"}, .split = {}, .value = options.value, .show = {}, .where = {}};
  Table table = without_empty_columns(pivot(own, spec).front());
  table.notes.clear();
  table.marks.reset();
  table.averages.reset();
  table.title = fmt::format("{}, {}, mean over {}",
                            lead->kind->times,
                            options.value,
                            sequences.size() == 1 ? "the runs of " + *sequences.begin()
                                                  : counted(sequences.size(), "sequence"));
  std::vector<Table> out;
  if (has_baseline && has_direction(options.value)) {
    const std::vector<Comparison> all =
        compare(compared, {.baseline = options.baseline, .value = options.value});
    sort_lines(table, all.front());
    out.push_back(verdict_table(verdict_of(all.front(), all)));
  }
  if (std::ranges::any_of(own, [](const Record& r) { return r.cell->is_stated(); }))
    table.notes.emplace_back(kStatedNote, kStatedInPaper);
  if (table.lines.size() > kMostMethods) {
    table.notes.push_back("and " + counted(table.lines.size() - kMostMethods, "more method"));
    table.lines.resize(kMostMethods);
  }
  const std::string oracle = oracle_closures_note(oracle_sequences, kMostSequences);
  if (!oracle.empty()) table.notes.push_back(oracle);
  for (const std::string& line : reasons(compared)) table.notes.emplace_back(line);
  if (stated != nullptr) {
    for (const Record& r : compared) {
      if (r.status != Status::ok) stated->insert(r.why);
    }
  }
  out.insert(out.begin(), std::move(table));
  return out;
}

}  // namespace loopbench::harness
