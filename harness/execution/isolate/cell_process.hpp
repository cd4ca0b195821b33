/// Cells in processes of their own, forked from a worker that has the sequence.
#pragma once

#include <string>
#include <vector>

#include "harness/execution/isolate/loaded_sequences.hpp"
#include "harness/execution/isolate/watched_process.hpp"
#include "harness/model/result.hpp"

namespace loopbench::harness {

class CellProcesses {
 public:
  /// `core`: the core to run on, or -1.
  CellProcesses(const WorkerContext& context, int core, WatchedProcesses& processes);
  ~CellProcesses();
  CellProcesses(const CellProcesses&) = delete;
  CellProcesses& operator=(const CellProcesses&) = delete;

  /// The packed CellResult without metadata, whatever the cell does. Throws std::runtime_error if
  /// no process can be created.
  std::string run(const Cell& cell, const LoadedSequences::Entry& entry);

 private:
  /// Hides the files of the sequence from programs of its cells.
  void hide_inputs(const LoadedSequences::Entry& entry);

  const WorkerContext& context_;
  int core_;
  int null_;  ///< /dev/null
  WatchedProcesses& processes_;
  std::vector<InputFile> hidden_;  ///< inputs that running servers cannot read
};

}  // namespace loopbench::harness
