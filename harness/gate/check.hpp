/// Is it still as good as it was?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/gate/baseline.hpp"

namespace loopbench {

struct Finding {
  enum class Kind {
    regression,   ///< worse beyond a limit, failed newly, vanished
    improvement,  ///< better beyond a limit, or works where it did not
    added         ///< not in the baseline
  };
  Kind kind = Kind::regression;
  std::string cell;   ///< as `name` has it; a method where the finding is over all its runs
  std::string score;  ///< empty: the cell as a whole
  std::string what;   ///< value before and now, with the limit
};

struct GateReport {
  std::size_t cells = 0;           ///< of the baseline
  std::size_t scores = 0;          ///< compared
  std::vector<std::string> names;  ///< of the baseline's cells, in order
  std::vector<Finding> findings;   ///< in the order of the baseline; over all runs last
  std::vector<std::string> notes;  ///< checks that could not be made, and why

  std::size_t count(Finding::Kind kind) const;
  bool passes() const { return count(Finding::Kind::regression) == 0; }
};

/// Whether `now` is all of the sweep, or a part of it whose missing cells are not missed.
enum class GateExtent { whole, part };

/// Throws InputError when the baseline's numbers were made from other definitions (see
/// definitions.hpp), or when not one of its cells is among these. A sequence or method that is gone
/// is not another one: its cells vanished. O(n log n) and one joint test of all methods and scores.
GateReport check(const Baseline& baseline,
                 const Snapshot& now,
                 GateExtent extent = GateExtent::whole);

}  // namespace loopbench
