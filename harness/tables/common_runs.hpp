/// Common runs of the entries of a table, so that their averages are comparable.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "harness/tables/by_run.hpp"

namespace loopbench::harness {

/// One entry of a column (or a row) of a table.
struct EntryRuns {
  RunSet tried;     ///< runs with any outcome
  RunSet finished;  ///< runs with a number; subset of `tried`
};

/// Returns for each entry the runs that all entries compared with it have finished. Two entries are
/// compared if both finished at least one run and tried a common run, directly or through other
/// entries. A method that fails everywhere and entries of other sequences therefore do not restrict
/// the runs. O(entries^2 * runs).
std::vector<RunSet> common_runs(const std::vector<EntryRuns>& entries);

/// Note below a table with means over common runs.
class CommonRunsNote {
 public:
  /// Records that a mean in this column (or row) is over `runs` runs.
  void add(const std::string& name, std::size_t runs) { runs_[name].insert(runs); }

  /// "means over the 4 runs that every method finished"; empty if nothing was added.
  std::string text() const;

 private:
  std::map<std::string, std::set<std::size_t>> runs_;
};

}  // namespace loopbench::harness
