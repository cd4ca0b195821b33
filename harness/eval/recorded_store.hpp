/// Stores the evaluation of files like a sweep: systems are methods, their runs are repeats.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "harness/eval/arguments.hpp"
#include "harness/eval/recorded_runs.hpp"
#include "harness/run/collect_provenance.hpp"

namespace loopbench::harness {

struct RecordedSweep {
  std::size_t cells = 0;   ///< of the store
  std::size_t stored = 0;  ///< of those, stored before
  std::size_t failed = 0;  ///< including runs of which a metric failed
  std::size_t incomplete = 0;
  std::vector<std::string>
      notes;  ///< on earlier runs, and of the files evaluated now (NoteSummary)
  std::vector<std::string> failures;  ///< "FILE: reason"
};

/// Evaluates the runs under all protocols of the arguments and writes them to
/// FOLDER/results.sqlite. Runs that the store already has are kept; unchanged files are not
/// evaluated again, except those that failed. Every run of a sequence is a group of its own, so
/// that conclusions hold for other runs on these sequences; runs with the same number on equal
/// references are one group, see recorded_group(). Throws InputError, also if the store is the
/// result of a sweep or has relative paths; the store is then unchanged. O(poses).
RecordedSweep store_runs(const std::vector<RecordedRun>& runs,
                         const EvalArguments& arguments,
                         const std::filesystem::path& folder,
                         const Source& source);

}  // namespace loopbench::harness
