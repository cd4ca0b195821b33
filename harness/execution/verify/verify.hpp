/// Does the same sweep give the same bits, however it is run?
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "harness/catalogue/catalogue.hpp"
#include "harness/model/cells.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench {

/// One way to run a sweep.
struct Manner {
  bool isolated = true;  ///< worker processes; else threads of this one
  int jobs = 1;

  std::string name() const;
};

/// A cell that came out otherwise than in the first manner.
struct Difference {
  std::size_t cell = 0;  ///< into the list of cells
  std::string manner;
  std::string part;  ///< "status", "scores", "trace" or "report": the first that differs
};

/// Runs all cells in each manner, the first of which is what the others are held to, and compares
/// everything but times and memory bit by bit. Cells that ended their worker are left out of
/// threads, and are not compared there. Ordered by manner, then cell. Throws as the sweeps do.
std::vector<Difference> verify(const Sweep& sweep,
                               const std::vector<Cell>& cells,
                               const Catalogue& catalogue,
                               const DataRoot& root,
                               const std::vector<Manner>& manners,
                               const std::atomic<bool>& stop,
                               const std::function<void(const std::string& manner)>& step);

}  // namespace loopbench
