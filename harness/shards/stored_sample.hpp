/// Recomputation of a sample of stored cells.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "harness/catalogue/catalogue.hpp"
#include "harness/execution/run/stop_requests.hpp"
#include "harness/model/sweep.hpp"
#include "harness/store/differing_cells.hpp"

namespace loopbench::harness {

struct SampleArguments {
  double share = 0.0;           ///< of the stored cells, 0..1
  std::filesystem::path store;  ///< folder of results
  std::string only;             ///< regular expression
  int jobs = 1;
};

/// A sweep and what it depends on.
struct SweepSetting {
  const Sweep& sweep;
  const Catalogue& catalogue;
  const DataRoot& root;
  std::string build;  ///< part of the cells' keys
};

struct RecomputedSample {
  std::size_t cells = 0;
  std::vector<CellDifference> differences;  ///< incomplete if `stop` was set
};

/// Recomputes a share of the cells of a store, at least one, and compares them bit by bit. The
/// sample is the same for every call. `on_cell(cells, label)` is called after each of the `cells`
/// with the label of its sequence. Throws InputError if the store has no cell of this sweep and
/// build.
RecomputedSample recompute_sample(
    const SweepSetting& setting,
    const SampleArguments& arguments,
    const StopRequests& stop,
    const std::function<void(std::size_t cells, const std::string& label)>& on_cell);

}  // namespace loopbench::harness
