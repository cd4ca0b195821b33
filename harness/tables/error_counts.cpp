#include "harness/tables/error_counts.hpp"

#include <algorithm>

namespace loopbench::harness {

void ErrorCounts::add(std::size_t column, const Record& record) {
  const std::size_t count = record.statistics.count;
  if (count < 2 || count == static_cast<std::size_t>(record.pairs)) return;
  auto& [least, most] = range_.try_emplace(column, count, count).first->second;
  least = std::min(least, count);
  most = std::max(most, count);
}

std::string ErrorCounts::text(const std::vector<std::string>& columns) const {
  std::string out;
  for (const auto& [column, range] : range_) {
    const auto& [least, most] = range;
    out += (out.empty() ? "" : "; ") + columns[column] + ": " + std::to_string(least);
    if (most != least) out += " to " + std::to_string(most);
  }
  return out;
}

}  // namespace loopbench::harness
