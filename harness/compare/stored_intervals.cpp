#include "harness/compare/stored_intervals.hpp"

#include <cmath>

#include "harness/compare/along_intervals.hpp"
#include "harness/store/traces.hpp"

namespace loopbench {

void add_intervals_from_traces(std::vector<Comparison>& comparisons,
                               const std::vector<Record>& records,
                               const std::filesystem::path& store) {
  Traces traces(store);
  std::map<std::string, std::int64_t> cells;
  std::string protocol;
  for (const Record& r : records) {
    cells.emplace(r.method + "\n" + run_name(r), r.cell);
    if (protocol.empty()) protocol = r.protocol;
  }
  for (Comparison& comparison : comparisons) {
    if (comparison.kind.protocol != protocol) continue;
    add_intervals_along_runs(comparison, [&](const std::string& method, const std::string& run) {
      StampedErrors out;
      const auto found = cells.find(method + "\n" + run);
      if (found == cells.end()) return out;
      const std::optional<CellTrace> trace = traces.cell(found->second);
      if (!trace || to_text(trace->times) != comparison.kind.times) return out;
      for (const TraceSample& sample : trace->samples) {
        out.stamps.push_back(sample.estimate.stamp);
        out.errors.push_back(std::hypot(sample.error_x, sample.error_y, sample.error_z));
      }
      return out;
    });
  }
}

}  // namespace loopbench
