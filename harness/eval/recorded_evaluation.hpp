/// Evaluation of files as cells of a store, with the identity of their runs.
#pragma once

#include <string>
#include <vector>

#include "harness/eval/arguments.hpp"
#include "harness/eval/recorded_sweep.hpp"
#include "harness/model/result.hpp"

namespace loopbench::harness {

/// Hash of the poses: a comment or another file name does not change it. O(poses).
std::string reference_content(const Trajectory& reference);

/// Hash of the poses of both. O(poses).
std::string pair_content(const Trajectory& reference, const Trajectory& estimate);

/// The same for a file that is not a trajectory: by its bytes. Empty if it cannot be read.
std::string unreadable_content(const std::string& reference_content, const std::string& estimate);

/// Evaluates cells that have one reference. A file that cannot be read is a failed cell. The notes
/// of the metadata are those of `eval` for the same files. Throws InputError for the reference.
std::vector<CellResult> evaluate_recorded(const std::vector<Cell>& cells,
                                          const Sweep& sweep,
                                          const Catalogue& catalogue,
                                          const EvalArguments& arguments);

}  // namespace loopbench::harness
