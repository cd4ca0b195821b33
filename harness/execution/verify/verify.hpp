/// Check that a sweep is bit-identical for any number of workers and threads.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/catalogue/catalogue.hpp"
#include "harness/execution/run/stop_requests.hpp"
#include "harness/execution/sandbox/sandbox.hpp"
#include "harness/model/cells.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Run mode of a sweep.
struct RunMode {
  bool isolated = true;  ///< worker processes; otherwise threads of this process
  int jobs = 1;

  std::string name() const;
};

/// A cell whose result differs from that of the first run mode.
struct Difference {
  std::size_t cell = 0;  ///< index into the list of cells
  std::string mode;
  std::string part;  ///< "status", "scores", "trace" or "report": the first that differs
};

/// Runs all cells in each mode and compares everything except times and memory bit by bit with the
/// first mode. Cells that ended their worker are skipped in threads and not compared there. Ordered
/// by mode, then cell. Throws as the sweeps do.
std::vector<Difference> verify(const Sweep& sweep,
                               const std::vector<Cell>& cells,
                               const Catalogue& catalogue,
                               const DataRoot& root,
                               const std::vector<RunMode>& modes,
                               const SandboxOptions& sandbox,
                               const StopRequests& stop,
                               const std::function<void(const std::string& mode)>& step);

}  // namespace loopbench::harness
