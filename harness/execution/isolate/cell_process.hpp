/// Cells in processes of their own, forked from a worker that has loaded the sequence.
#pragma once

#include <string>
#include <vector>

#include "harness/execution/isolate/loaded_sequences.hpp"
#include "harness/execution/isolate/result_area.hpp"
#include "harness/execution/sandbox/sandbox.hpp"
#include "harness/external/scratch.hpp"
#include "harness/model/result.hpp"

namespace loopbench::harness {

/// Runs cells one after another, each in a copy of the worker, with nothing of earlier cells. The
/// worker enforces the limits and ends everything that the cell started.
class CellProcesses {
 public:
  /// `sweep`: socket to it; `core`: the core to run on, or -1; `scratch`: for programs, writable,
  /// or null; `group`: of the worker. Throws std::runtime_error without shared memory.
  CellProcesses(const WorkerContext& context,
                int sweep,
                int core,
                const ScratchFolder* scratch,
                const ControlGroup& group);
  ~CellProcesses();
  CellProcesses(const CellProcesses&) = delete;
  CellProcesses& operator=(const CellProcesses&) = delete;

  /// The packed CellResult without metadata, whatever the cell does. Ends the process if the sweep
  /// has ended. Throws std::runtime_error if no process can be created.
  std::string run(const Cell& cell, const LoadedSequences::Entry& entry);

 private:
  /// Hides the files of the sequence from programs of its cells.
  void hide_inputs(const LoadedSequences::Entry& entry);
  /// Packed result of a cell that left none.
  std::string packed_failure(const Cell& cell,
                             Status status,
                             const std::string& why,
                             const std::string& signal) const;

  const WorkerContext& context_;
  int sweep_;
  int core_;
  int null_;  ///< /dev/null
  const ScratchFolder* scratch_;
  const ControlGroup& group_;
  std::int64_t ended_by_limit_ = 0;  ///< of the group, before the running cell
  ResultArea area_;
  std::vector<InputFile> hidden_;  ///< inputs that running servers cannot read
};

}  // namespace loopbench::harness
