/// Columns of a table whose values are over fewer errors than the evaluated poses.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "harness/answers/tables/table_numbers.hpp"

namespace loopbench::harness {

/// Ignores single values and scores with as many errors as evaluated poses.
inline void add_error_count(TableNumbers& table, std::size_t column, const Record& record) {
  const std::size_t count = record.statistics.count;
  if (count < 2 || count == static_cast<std::size_t>(record.pairs)) return;
  auto& [least, most] = table.error_counts.try_emplace(column, count, count).first->second;
  least = std::min(least, count);
  most = std::max(most, count);
}

/// "rpe 1 s [m]: 396 to 398; ..."; empty if every value is over the evaluated poses.
inline std::string error_counts_text(const TableNumbers& table) {
  std::vector<std::string> out;
  for (const auto& [column, range] : table.error_counts) {
    const auto& [least, most] = range;
    out.push_back(fmt::format("{}: {}", table.columns.names()[column], least));
    if (most != least) out.back() += fmt::format(" to {}", most);
  }
  return fmt::format("{}", fmt::join(out, "; "));
}

}  // namespace loopbench::harness
