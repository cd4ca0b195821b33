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

/// The reference of several cells, read once.
struct SharedReference {
  RecordedFile read;
  InputFile file;
  std::string content;  ///< see reference_content()
};

/// `options`: of a dataset of recorded_sweep(). Throws InputError.
SharedReference shared_reference(const Params& options);

/// Evaluates cells that have this reference. An estimate that cannot be read is a failed cell. The
/// notes of the metadata are those of `eval` for the same files. No times are recorded, because
/// they would be those of copying poses, not of the system.
std::vector<CellResult> evaluate_recorded(const std::vector<Cell>& cells,
                                          const SharedReference& reference,
                                          const Sweep& sweep,
                                          const Catalogue& catalogue,
                                          const EvalArguments& arguments);

}  // namespace loopbench::harness
