#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "harness/profile/grouping.hpp"
#include "harness/profile/profile.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {

TableView scaling(const std::vector<CellRecord>& cells) {
  TableView out{
      "scaling: time ~ keyframes^exponent",
      {"method", "sizes", "keyframes", "exponent", "standard error", "R2", "largest [ms]"},
      {},
      {}};
  for (const auto& [method, all] : by_method(cells)) {
    std::map<std::int64_t, std::vector<double>> by_size;
    for (const CellRecord* cell : all) {
      if (is_finished(*cell) && cell->keyframes > 0)
        by_size[cell->keyframes].push_back(cell->seconds);
    }
    std::vector<double> sizes;
    std::vector<double> times;
    for (const auto& [size, seconds] : by_size) {
      sizes.push_back(static_cast<double>(size));
      times.push_back(metrics::median(seconds));
    }
    const auto law = power_law(sizes, times);
    if (!law) continue;
    out.lines.push_back({table_name(method, all),
                         std::to_string(sizes.size()),
                         fmt::format("{} to {}", by_size.begin()->first, by_size.rbegin()->first),
                         fmt::format("{:.2f}", law->exponent),
                         fmt::format("{:.2f}", law->error),
                         fmt::format("{:.3f}", law->r2),
                         fmt::format("{:.4g}", 1e3 * times.back())});
  }
  if (lacks_times(cells)) {
    out.notes.push_back(kNoTimes);
  } else if (out.lines.empty()) {
    out.notes.push_back(
        "none: needs at least three numbers of keyframes, the largest four times the "
        "smallest, for example `sweep: {keyframes: [100, 1000, 10000]}`");
  }
  std::ranges::move(oracle_notes(cells), std::back_inserter(out.notes));
  return out;
}

}  // namespace loopbench::harness
