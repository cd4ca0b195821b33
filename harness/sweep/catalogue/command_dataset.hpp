/// The dataset `command`: any program as a SLAM system.
///
/// The program reads {sequence} and writes {trajectory}, the estimate without loop closing, as TUM;
/// and if it has them, next to it, {trajectory}.frames (all tracked poses), {trajectory}.loops
/// (closures, derive/closure_file.hpp) and {trajectory}.closed (its own estimate with loop
/// closing).
#pragma once

#include <filesystem>

#include "datasets/dataset.hpp"
#include "harness/sweep/model/sweep.hpp"

namespace loopbench::harness {

/// Its entry. Outputs of programs are kept in `cache`; empty: in TMPDIR, which ends with a worker.
DatasetEntry command_dataset(const std::filesystem::path& cache);

/// Limits of loading a sequence: `of_cells`, except what the options of a program state.
Limits loading_limits(const Choice& dataset, Limits of_cells);

/// The limits of cells, with the time of the sequence that may load for longest.
Limits longest_limits(const Sweep& sweep);

}  // namespace loopbench::harness
