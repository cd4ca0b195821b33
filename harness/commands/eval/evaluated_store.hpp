/// A store of evaluated files: the runs that it has already, and what `eval --store` prints.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/answers/tables/reasons.hpp"
#include "harness/commands/eval/evaluated_sweep.hpp"
#include "harness/commands/eval/file_evaluation.hpp"
#include "harness/sweep/model/result.hpp"

namespace loopbench::harness {

/// The runs of a store, where `added` replace runs with the same labels, and then the others of
/// `added`. `notes`: receives runs that are replaced by another file. Throws InputError if the
/// store is the result of a sweep, or a sequence has two references, whose results cannot be
/// averaged.
std::vector<EvaluatedRun> with_stored(const std::filesystem::path& file,
                                      const std::vector<EvaluatedRun>& added,
                                      std::vector<std::string>& notes);

/// A note on stored runs that are evaluated although they were not given; empty if there is none.
std::string evaluated_again(const std::vector<Cell>& missing,
                            const std::vector<EvaluatedRun>& runs,
                            const std::vector<EvaluatedRun>& added);

/// What was written to a store.
class StoreSummary {
 public:
  /// `incomplete`: runs with a low coverage that the store had.
  explicit StoreSummary(std::size_t incomplete) : incomplete_(incomplete) {}

  void add(const FileEvaluation& evaluation, const std::string& estimate);

  /// None failed, of no run a metric failed, and none has a low coverage.
  bool is_ok() const { return failures_.empty() && incomplete_ == 0; }

  /// One line for each kind of notes, or for each text of those without numbers: that of the first
  /// file with it, and the number of further files. Findings of the doctor first, then in order of
  /// appearance.
  std::vector<std::string> notes() const;

  /// "40 runs in FILE (39 stored before), 1 failed", and the reasons of at most five failures.
  std::string text(const std::filesystem::path& file,
                   const EvaluatedSweep& files,
                   std::size_t stored) const;

 private:
  std::size_t incomplete_;
  std::vector<std::string> failures_;                   ///< "FILE: reason"
  ListsByKey<std::pair<NoteKind, std::string>> notes_;  ///< by kind, and text without numbers
};

}  // namespace loopbench::harness
