/// The runs over which the numbers of a table may be averaged so that they can be compared.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace loopbench::harness {

/// One cell of a column (or a row) of a table, by names of runs.
struct CellRuns {
  std::set<std::string> tried;     ///< with any outcome
  std::set<std::string> finished;  ///< with a number; part of `tried`
};

/// For each cell the runs that all cells finished which are compared with it; empty where there is
/// none. Compared are cells that finished at least one run and tried a run in common, directly or
/// through others: a method that fails everywhere restricts nobody, and nor do cells of other
/// sequences. O(cells^2 * runs).
std::vector<std::set<std::string>> common_runs(const std::vector<CellRuns>& cells);

/// What a reader must know of means over common runs, in one line.
class CommonRunsNote {
 public:
  /// A mean in this column (or row) is over so few runs.
  void add(const std::string& lane, std::size_t runs) { runs_[lane].insert(runs); }

  /// "means over the 4 runs that every method finished"; empty when nothing was added.
  std::string text() const;

 private:
  std::map<std::string, std::set<std::size_t>> runs_;
};

}  // namespace loopbench::harness
