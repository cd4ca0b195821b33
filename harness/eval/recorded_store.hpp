/// Stores the evaluation of files like a sweep: systems are methods, their runs are repeats.
#pragma once

#include <string>
#include <vector>

#include "harness/eval/recorded_sweep.hpp"
#include "harness/run/build.hpp"

namespace loopbench::harness {

struct StoredRuns {
  std::string summary;             ///< "40 runs in FILE (39 stored before), 1 failed", and reasons
  std::vector<std::string> notes;  ///< on earlier runs, and of the files evaluated now
  bool are_ok = true;              ///< none failed or has a low coverage
};

/// Evaluates the runs under all protocols of the arguments and writes them to
/// FOLDER/results.sqlite. Runs that the store already has are kept; unchanged files are not
/// evaluated again, except those that failed. Every run of a sequence is a group of its own, so
/// that conclusions hold for other runs on these sequences; runs with the same number on equal
/// references are one group, see recorded_group(). Throws InputError, also if the store is the
/// result of a sweep; the store is then unchanged. O(poses).
StoredRuns store_runs(const std::vector<RecordedRun>& runs,
                      const EvalArguments& arguments,
                      const Source& source);

}  // namespace loopbench::harness
