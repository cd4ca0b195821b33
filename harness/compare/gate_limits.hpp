/// The limits of a gate.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "datasets/core/error.hpp"
#include "harness/compare/baseline.hpp"
#include "harness/model/where.hpp"

namespace loopbench::harness {

inline bool selects_a_score(const Tolerance& limit, const Snapshot& snapshot) {
  const auto keeps = where(limit.where);
  return std::ranges::any_of(snapshot.records,
                             [&](const Record& r) { return r.has_score() && keeps(r); });
}

inline std::string numbers_of(const Tolerance& limit) {
  return fmt::format("{}: relative {:g}, absolute {:g}",
                     fmt::join(limit.values, ", "),
                     limit.relative,
                     limit.absolute);
}

/// A function that returns the first of the limits whose `where` selects a score, or null. It keeps
/// references to `limits`.
inline std::function<const Tolerance*(const Record&)> limit_of(
    const std::vector<Tolerance>& limits) {
  std::vector<std::function<bool(const Record&)>> filters;
  for (const Tolerance& limit : limits) filters.push_back(where(limit.where));
  return [filters, &limits](const Record& score) {
    const auto selects = [&](const auto& keeps) { return keeps(score); };
    const auto found = std::ranges::find_if(filters, selects) - filters.begin();
    return found == std::ssize(filters) ? nullptr : &limits[static_cast<std::size_t>(found)];
  };
}

/// Throws InputError if the baseline has no limits, or a limit that selects none of its scores:
/// such a limit is misspelt and would let every change pass. A baseline without any score is only
/// about statuses.
inline void require_used_limits(const Baseline& baseline) {
  if (baseline.limits.empty()) {
    throw InputError("limits: is empty, so that every change would pass; expected at least one");
  }
  if (std::ranges::none_of(baseline.snapshot.records, &Record::has_score)) return;
  for (std::size_t i = 0; i < baseline.limits.size(); ++i) {
    const Tolerance& limit = baseline.limits[i];
    if (selects_a_score(limit, baseline.snapshot)) continue;
    throw InputError(fmt::format("limits[{}].where: '{}' selects no score of the baseline",
                                 i,
                                 fmt::join(limit.where, ", ")));
  }
}

/// A line for every limit that is not the default, because a wide limit lets changes pass.
inline std::vector<std::string> notes_on_limits(const std::vector<Tolerance>& limits) {
  const std::string standard = numbers_of({});
  std::vector<std::string> out;
  for (const Tolerance& limit : limits) {
    const std::string own = numbers_of(limit);
    if (own == standard) continue;
    out.push_back(fmt::format(
        "limit of {}: {} (default: {})",
        limit.where.empty() ? "all scores" : fmt::format("{}", fmt::join(limit.where, ", ")),
        own,
        standard));
  }
  return out;
}

}  // namespace loopbench::harness
