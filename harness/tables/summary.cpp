#include "harness/tables/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "harness/compare/compare.hpp"
#include "harness/compare/observations.hpp"
#include "harness/compare/signed_rank.hpp"
#include "harness/model/name_order.hpp"
#include "harness/tables/notes.hpp"
#include "harness/tables/pivot.hpp"
#include "metrics/numerics/average.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostSequences = 12;
constexpr std::size_t kMostMethods = 30;
constexpr std::size_t kMostVerdicts = 5;
constexpr std::size_t kMostReasons = 5;

bool is_derived(const Record& r) {
  return r.kind->metric == "gain" || r.kind->metric == "pairs" || r.kind->metric == "time";
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

/// Texts by row name of the derived score with that label: "gain", "time".
std::map<std::string, std::string> derived_texts(const std::vector<Record>& records,
                                                 const std::string& label,
                                                 const Record& lead,
                                                 const std::string& value) {
  std::vector<Record> own;
  for (const Record& r : records) {
    if (r.status == Status::ok && r.kind->times == lead.kind->times &&
        r.kind->protocol == lead.kind->protocol && is_derived(r) &&
        r.kind->metric_label() == label) {
      own.push_back(r);
    }
  }
  std::map<std::string, std::string> out;
  if (own.empty()) return out;
  const TableSpec spec{.columns = {"metric"}, .split = {}, .value = value, .show = {}, .where = {}};
  const Table table = pivot(own, spec).front();
  for (const auto& line : table.lines) out[line[0].text] = line[1].text;
  return out;
}

void add_column(Table& out,
                const std::string& heading,
                const std::map<std::string, std::string>& texts) {
  if (texts.empty()) return;
  out.headings.push_back(heading);
  for (auto& line : out.lines) {
    const auto found = texts.find(line[0].text);
    line.emplace_back(found == texts.end() ? "-" : found->second);
  }
}

std::vector<std::string> verdicts(const std::vector<Record>& candidates,
                                  const SummaryOptions& options) {
  CompareOptions how;
  how.baseline = options.baseline;
  how.value = options.value;
  std::vector<std::string> out;
  std::vector<std::string> seen;
  std::size_t left_out = 0;
  const std::vector<Comparison> all = compare(candidates, how);
  // With too few runs the sentences are the same for all scores.
  const bool can_prove = std::ranges::any_of(all, [](const Comparison& c) { return c.can_show; });
  const std::size_t most = can_prove ? kMostVerdicts : 1;
  for (const Comparison& c : all) {
    const std::string score = c.kind.short_name();
    // The rotation of a score that also has a translation is in `compare`.
    if (std::ranges::count(seen, score) > 0) continue;
    seen.push_back(score);
    if (out.size() < most) {
      out.push_back(statement(c));
    } else {
      ++left_out;
    }
  }
  if (left_out > 0) {
    out.push_back(fmt::format("{}{} more score{}: see compare",
                              can_prove ? "" : "likewise for ",
                              left_out,
                              left_out == 1 ? "" : "s"));
  }
  return out;
}

constexpr double kLost = std::numeric_limits<double>::max();  // worse than all values

/// A value for which lower is better.
double as_loss(double value, const ScoreKind& kind) {
  switch (kind.better) {
    case metrics::Better::higher:
      return -value;
    case metrics::Better::target:
      return std::abs(value - kind.target);
    default:
      return value;
  }
}

/// Mean over runs of each method's rank among the methods that ran there: 1 for the best, ties
/// share the mean of their ranks, methods that failed share the ranks after the last value. Methods
/// that use the reference are not ranked. `records` are those of one score, and of cells without
/// scores. Throws InputError for an unknown statistic `value`. O(n log n).
std::map<std::string, double> mean_ranks(const std::vector<Record>& records,
                                         const std::string& value) {
  std::vector<Record> ranked = records;
  std::erase_if(ranked, [](const Record& r) { return r.cell->oracle; });
  const std::vector<Observations> all = observations(ranked, value);
  if (all.empty()) return {};
  Observations kind = all.front();
  if (kind.kind.better == metrics::Better::neither) return {};
  drop_duplicates(kind);
  std::map<std::string, std::vector<double>> ranks;
  for (std::size_t run = 0; run < kind.runs.size(); ++run) {
    std::vector<std::string> methods;
    std::vector<double> losses;
    bool has_value = false;
    for (std::size_t m = 0; m < kind.methods.size(); ++m) {
      const Observed& one = kind.values[m][run];
      if (!one.value && !one.is_loss) continue;
      methods.push_back(kind.methods[m]);
      losses.push_back(one.value ? as_loss(*one.value, kind.kind) : kLost);
      has_value = has_value || one.value;
    }
    if (!has_value) continue;
    const std::vector<double> own = midranks(losses, kTieShare);
    for (std::size_t i = 0; i < own.size(); ++i) ranks[methods[i]].push_back(own[i]);
  }
  std::map<std::string, double> out;
  for (const auto& [method, own] : ranks) out[method] = metrics::mean(own);
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

}  // namespace

Table summary(const std::vector<Record>& records, const SummaryOptions& options) {
  const std::vector<Record> candidates = comparable(records, options);
  const auto lead = std::ranges::find_if(candidates, [](const Record& r) { return r.has_score(); });
  if (lead == candidates.end()) return {};
  std::vector<Record> own;
  NameOrder sequences;
  std::set<std::string> oracle_sequences;
  for (const Record& r : candidates) {
    if (r.has_score() && r.kind != lead->kind) continue;
    own.push_back(r);
    sequences.index(r.cell->sequence);
    if (r.cell->oracle_closures) oracle_sequences.insert(r.cell->sequence);
  }
  const bool has_sequences = sequences.names().size() <= kMostSequences;
  const TableSpec spec{.columns = {has_sequences ? "sequence" : "score"},
                       .split = {},
                       .value = options.value,
                       .show = {},
                       .where = {}};
  std::string unit = unit_of(*lead->kind, options.value);
  if (!unit.empty()) unit = " [" + unit + "]";
  // Records without a score belong to their sequence's column.
  Table out = without_empty_columns(pivot(own, spec).front());
  if (has_sequences) {
    for (std::size_t c = 1; c < out.headings.size(); ++c) {
      out.headings[c].resize(out.headings[c].size() - unit.size());
    }
  } else {
    out.headings.resize(1);
    for (auto& line : out.lines) line.resize(1);
  }
  out.notes.clear();
  out.title = fmt::format("{}{}, {}, {}{}",
                          lead->kind->short_name(),
                          unit,
                          lead->kind->times,
                          options.value,
                          has_sequences ? " by sequence" : "");

  const std::map<std::string, double> ranks = mean_ranks(own, options.value);
  std::map<std::string, std::string> rank_texts;
  for (const auto& [method, rank] : ranks) rank_texts[method] = fixed(rank, 1);
  add_column(out, "mean rank", rank_texts);
  const bool is_labelled = lead->kind->metric == "ate" && lead->kind->metric_label() != "ate";
  const std::string gain = is_labelled ? "gain (" + lead->kind->metric_label() + ")" : "gain";
  // The gain is always that of the ATE.
  if (has_direction(options.value)) {
    add_column(out,
               lead->kind->metric == "ate" ? "gain [%]" : "ATE gain [%]",
               derived_texts(records, gain, *lead, options.value));
  }
  add_column(out, "time [ms]", derived_texts(records, "time", *lead, "rmse"));

  if (std::ranges::any_of(own, [](const Record& r) { return r.cell->is_stated(); }))
    out.notes.emplace_back(kStatedNote);

  const auto rank_of = [&](const auto& line) {
    const auto found = ranks.find(line[0].text);
    return found == ranks.end() ? std::numeric_limits<double>::infinity() : found->second;
  };
  std::ranges::stable_sort(out.lines, {}, rank_of);
  if (out.lines.size() > kMostMethods) {
    out.notes.push_back(fmt::format("and {} more methods", out.lines.size() - kMostMethods));
    out.lines.resize(kMostMethods);
  }
  if (!has_sequences) out.notes.push_back(fmt::format("{} sequences", sequences.names().size()));
  const std::string oracle = oracle_closures_note(oracle_sequences, kMostSequences);
  if (!oracle.empty()) out.notes.push_back(oracle);
  for (std::string& line : reasons(own)) out.notes.push_back(std::move(line));
  const auto is_baseline = [&](const Record& r) { return r.cell->method == options.baseline; };
  const bool has_verdicts = has_direction(options.value);
  if (has_verdicts &&
      std::ranges::any_of(candidates, is_baseline)) {  // `run --only` can leave it out
    for (std::string& line : verdicts(candidates, options)) out.notes.push_back(std::move(line));
  }
  return out;
}

}  // namespace loopbench::harness
