/// Success rates over runs.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "datasets/core/error.hpp"
#include "harness/answers/tables/table.hpp"
#include "harness/sweep/model/record.hpp"

namespace loopbench::harness {

inline bool is_ranked_total(const Record& r) {
  const bool is_directed =
      r.kind->better == metrics::Better::lower || r.kind->better == metrics::Better::higher;
  return r.has_score() && has_numbers(r.status) && r.kind->is_total() && is_directed;
}

/// Wilson's interval of a share, as text in percent.
inline std::string wilson(double successes, double runs) {
  constexpr double kQuantile = 1.959963984540054;  // of 97.5 %
  const double square = kQuantile * kQuantile / runs;
  const double share = successes / runs;
  const double middle = share + 0.5 * square;
  const double half = kQuantile * std::sqrt(share * (1.0 - share) / runs + 0.25 * square / runs);
  const auto percent = [&](double value) {
    return fmt::format("{:.1f}", std::clamp(100.0 * value / (1.0 + square), 0.0, 100.0));
  };
  return percent(middle - half) + " to " + percent(middle + half);
}

/// One line for each method: its runs (cells), those that succeeded, their share and its 95 %
/// interval. A run succeeds if the statistic of the first directed score over all axes is at most
/// `limit` (at least, if higher is better); failed and incomplete runs do not, and runs that a
/// method declines are left out. Throws InputError for an unknown statistic, or without such a
/// score. O(n log n).
///
/// Source of the interval: E. Wilson, Probable inference, the law of succession, and statistical
/// inference, JASA 22, 1927.
inline Table success_table(const std::vector<Record>& records,
                           const std::string& statistic,
                           double limit) {
  value(Record{}, statistic);  // rejects an unknown one
  const auto score = std::ranges::find_if(records, is_ranked_total);
  if (score == records.end()) throw InputError("--success: no run has a score with a direction");
  const bool is_lower = score->kind->better == metrics::Better::lower;
  struct Runs {
    std::string method;
    std::set<std::int64_t> cells = {}, successes = {};
  };
  std::vector<Runs> all;
  for (const Record& r : records) {
    if (!r.has_score() && r.status == Status::declined) continue;
    auto own = std::ranges::find(all, r.cell->method.text(), &Runs::method);
    if (own == all.end()) own = all.insert(all.end(), {r.cell->method.text()});
    own->cells.insert(r.cell->position);
    if (r.status != Status::ok || r.kind != score->kind) continue;
    const double found = value(r, statistic);
    if (is_lower ? found <= limit : found >= limit) own->successes.insert(r.cell->position);
  }
  Table out{fmt::format("success: {}, {} of at {} {:g} {}, {}, {}",
                        score->kind->short_name(),
                        statistic,
                        is_lower ? "most" : "least",
                        limit,
                        unit_of(*score->kind, statistic),
                        score->kind->protocol,
                        score->kind->times),
            {"method", "runs", "successful", "share [%]", "95 % interval [%]"},
            {},
            {}};
  for (const auto& [method, cells, successes] : all) {
    const auto runs = static_cast<double>(cells.size());
    const auto good = static_cast<double>(successes.size());
    out.lines.push_back({method,
                         std::to_string(cells.size()),
                         std::to_string(successes.size()),
                         fmt::format("{:.1f}", 100.0 * good / runs),
                         wilson(good, runs)});
  }
  return out;
}

}  // namespace loopbench::harness
