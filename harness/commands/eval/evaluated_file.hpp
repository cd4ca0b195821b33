/// Reading of the files of `eval`.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/params.hpp"
#include "datasets/formats/formats.hpp"
#include "harness/commands/eval/arguments.hpp"
#include "harness/commands/eval/evaluated_runs.hpp"
#include "harness/sweep/model/note.hpp"

namespace loopbench::harness {

/// Poses of a file and the remarks of its reader.
struct EvaluatedFile {
  Trajectory poses;
  std::vector<PoseMatrix> matrices = {};  ///< as printed; only of KITTI files, and if needed
  ReadFindings findings = {};             ///< its covariances are of `poses`
  FileClock clock = {};  ///< with the rows of the file, also those that are not poses
  /// The row of each pose, ascending from 0 on, if some were dropped or cut; empty: consecutive, or
  /// not known because rows were sorted or had repeated stamps.
  std::vector<std::size_t> rows = {};
};

/// Keeps the poses with these indices, with all that belongs to them.
void keep_poses(EvaluatedFile& file, const std::vector<std::size_t>& indices);

/// Read a file as the arguments state, without poses that they filter out; the reference is in the
/// body of the estimates and within the time range. The unit of its stamps is that under which it
/// has most time in common with `estimate`, if several fit.
/// `with_digits`: also the digits of KITTI files. Throw InputError, OptionError.
EvaluatedFile evaluated_reference(const std::string& file,
                                  const EvalArguments& arguments,
                                  bool with_digits,
                                  const std::string& estimate = {});
/// The unit of the stamps is likewise decided by `reference`. If the positions of `reference` have
/// no rotation, the estimate is converted to its body; local coordinates of latitudes and
/// longitudes have its origin.
EvaluatedFile evaluated_estimate(const std::string& file,
                                 const EvalArguments& arguments,
                                 bool with_digits,
                                 const EvaluatedFile* reference = nullptr);

/// What reading a file changed, chose and assumed. `whose`: reference or estimate.
std::vector<Note> reading_notes(const ReadFindings& findings, const std::string& whose);

/// Handling of equal stamps: as stated, otherwise that of evo if every protocol pairs as evo does.
/// Throws OptionError.
Repeats repeats_of(const EvalArguments& arguments);

/// The arguments by which all files are read, as options. Throws OptionError for invalid ones.
Params reading_options(const EvalArguments& arguments);

/// Throws InputError for a times file or a period that no file uses.
void check_stamp_options(const EvalArguments& arguments, const std::vector<EvaluatedRun>& runs);

}  // namespace loopbench::harness
