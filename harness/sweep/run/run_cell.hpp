/// Runs one cell; only the method is timed, and its exceptions are stored in its row.
#pragma once

#include "datasets/core/sequence.hpp"
#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/model/result.hpp"
#include "harness/sweep/model/sweep.hpp"

namespace loopbench::harness {

/// Call it in a new process, for its memory and time. Does not throw for errors of a method or
/// metric: they are stored as status and why.
CellResult run_cell(const Cell& cell,
                    const Sweep& sweep,
                    const Sequence& sequence,
                    const Catalogue& catalogue);

}  // namespace loopbench::harness
