/// Programs that stay running and answer one problem after another.
///
/// The same line as a method and as a metric is two programs, because one has seen references. Each
/// has a folder for temporary files of its own.
///
/// A program belongs to the thread that first used it, and to processes that are forked from it
/// later: they inherit its streams, one at a time. A flag in shared memory is set while a request
/// is unanswered. If it is still set at the next request, because the requesting process was
/// killed, or if the program has ended, the program is started again; so a program that crashes,
/// hangs or writes something else costs one cell.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "harness/sweep/catalogue/command.hpp"
#include "harness/sweep/process/descendants.hpp"
#include "methods/incremental.hpp"

namespace loopbench::harness {

/// Starts the program of `options.serve` unless it is running and in step. A process that forks
/// others to send requests calls it first; otherwise each of them starts its own program. Throws
/// std::runtime_error.
void prepare_server(const CommandOptions& options);

/// What a cell in a copy of this process needs to keep: the servers that run in this thread.
struct RunningServers {
  std::vector<pid_t> processes;  ///< children of this process
  std::vector<int> descriptors;  ///< their streams
};
RunningServers running_servers();

/// Ends the servers of this thread; `only_stuck`: those that have ended or have not answered,
/// because the requesting process was killed.
void end_servers(bool only_stuck = false);

/// The bytes of a request with a number.
using Request = std::function<std::string(std::uint64_t number)>;

struct ServedAnswer {
  std::string text;      ///< JSON
  std::string data;      ///< rows of float64
  double seconds = 0.0;  ///< from handing over the request to the last byte of the answer
  TreeCost cost;         ///< CPU time between these, and the largest memory so far
};

/// Asks the program of `options.serve`, which is started if it is not running. The first request is
/// handed over when the program begins to read it: its start is not part of `seconds`. `poses`
/// limits the size of the answer. `errors` receives what it prints. Throws std::runtime_error if
/// the program fails.
ServedAnswer ask_served(const CommandOptions& options,
                        const Request& request,
                        std::size_t poses,
                        std::string& errors);

/// Sends the problem and returns the checked answer. Throws std::runtime_error if the program
/// fails, and Undefined if it declines.
Trajectory ask_server(const CommandOptions& options,
                      const Problem& problem,
                      methods::Report& report);

/// The program as a method that extends its solution: each update sends what has arrived since the
/// last one, so the program keeps the rest. Throws as ask_server(); an update that fails or
/// declines ends the replay.
std::unique_ptr<methods::Incremental> served_updates(const CommandOptions& options, bool planar);

}  // namespace loopbench::harness
