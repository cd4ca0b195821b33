#include "harness/execution/isolate/cell_process.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>

#include "harness/execution/isolate/cell_child.hpp"
#include "harness/execution/isolate/pack_result.hpp"
#include "harness/execution/run/oracle_method.hpp"
#include "harness/external/external_methods.hpp"
#include "harness/external/server.hpp"

namespace loopbench::harness {

CellProcesses::CellProcesses(const WorkerContext& context, int core, WatchedProcesses& processes)
    : context_(context),
      core_(core),
      null_(open("/dev/null", O_RDWR | O_CLOEXEC)),
      processes_(processes) {}

CellProcesses::~CellProcesses() { close(null_); }

void CellProcesses::hide_inputs(const LoadedSequences::Entry& entry) {
  const std::vector<InputFile>& inputs = entry.metadata.inputs;
  if (!std::ranges::equal(inputs, hidden_, {}, &InputFile::path, &InputFile::path)) {
    hidden_ = inputs;
    end_servers();  // they are in the previous sandbox
  }
  program_sandbox() = context_.sandbox;
  for (const InputFile& input : inputs) program_sandbox().hidden.emplace_back(input.path);
}

std::string CellProcesses::run(const Cell& cell, const LoadedSequences::Entry& entry) {
  const Sweep& sweep = context_.sweep;
  if (uses_programs(sweep)) hide_inputs(entry);
  prepare_programs(sweep.methods[cell.method], command_setting(sweep));
  const std::vector<int> kept = running_servers().descriptors;
  const pid_t worker = getpid();
  const ProcessEnd end = processes_.run("the cell", "", [&](ResultArea& area, int output) {
    run_cell_and_exit({context_, cell, entry.sequence, worker, core_, null_, output, area, kept});
  });
  if (end.status == Status::ok) return std::string(end.result);
  CellResult result;
  result.cell = cell;
  result.status = end.status;
  result.why = end.why;
  result.signal = end.signal;
  result.worker = {true, sweep.serial, core_ >= 0};
  result.oracle_method = uses_reference(sweep.methods[cell.method], context_.catalogue);
  Packer pack;
  pack(result);
  return pack.bytes();
}

}  // namespace loopbench::harness
