/// Comparison of a sweep with its baseline.
#pragma once

#include <string>
#include <vector>

#include "harness/compare/baseline.hpp"

namespace loopbench::harness {

struct Finding {
  enum class Kind {
    regression,   ///< worse beyond a limit, newly failed, or missing
    improvement,  ///< better beyond a limit, or newly working
    added         ///< not in the baseline
  };
  Kind kind = Kind::regression;
  std::string cell;   ///< result of `name`
  std::string score;  ///< empty: the complete cell
  std::string what;   ///< old and new value, with the limit
};

struct GateReport {
  std::size_t cells = 0;           ///< of the baseline
  std::size_t scores = 0;          ///< compared scores, that is, those with a limit
  std::vector<std::string> names;  ///< of the baseline's cells, in order
  std::vector<Finding> findings;   ///< in the order of the baseline
  std::vector<std::string> notes;  ///< checks that were not possible, with the reason

  std::size_t count(Finding::Kind kind) const;
  bool passes() const { return count(Finding::Kind::regression) == 0; }
};

/// Whether `now` is the complete sweep, or a part whose missing cells are accepted.
enum class GateExtent { complete, part };

/// Throws InputError if the baseline was computed with other definitions (see snapshot.hpp), has
/// no cell in common with the results, or has a limit that selects no score. Removed sequences or
/// methods are reported as missing cells, not as other definitions. O(n log n).
GateReport check(const Baseline& baseline,
                 const Snapshot& now,
                 GateExtent extent = GateExtent::complete);

}  // namespace loopbench::harness
