/// Evaluation of files as cells of a sweep, in this process.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/commands/eval/evaluated_file.hpp"
#include "harness/commands/eval/evaluated_sweep.hpp"
#include "harness/commands/eval/evaluation_result.hpp"
#include "harness/sweep/model/result.hpp"

namespace loopbench::harness {

/// The reference of several cells, read once.
struct SharedReference {
  EvaluatedFile read;        ///< poses in the body of the estimates
  std::string content = {};  ///< hash of the poses, so that names and comments do not matter;
                             ///< empty: runs are not compared
  std::optional<InputFile> file = {};  ///< for a store
  bool is_traced = false;              ///< for a store or a page
};

/// Throws InputError.
SharedReference shared_reference(const std::string& file, const EvaluatedSweep& files);

/// The result of a cell, and what a cell does not contain, for each protocol of the sweep.
struct FileEvaluation {
  CellResult result;
  std::vector<EvaluationResult> protocols;  ///< without records
};

/// Evaluates an estimate under all protocols of the sweep. Metrics that fail are in the result; a
/// protocol under which nothing can be evaluated has a `why_failed`. No times are recorded, because
/// no method runs. O((n + m) log(n + m)).
FileEvaluation evaluate_poses(const Cell& cell,
                              const EvaluatedSweep& files,
                              const SharedReference& reference,
                              const EvaluatedFile& estimate);

/// The same for the file of the cell. If it cannot be read, the cell and all protocols fail.
FileEvaluation evaluate_file(const Cell& cell,
                             const EvaluatedSweep& files,
                             const SharedReference& reference);

}  // namespace loopbench::harness
