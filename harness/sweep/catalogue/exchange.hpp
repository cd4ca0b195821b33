/// Folder in which a problem is handed to an external program, and the program's result.
///
/// Version 1 of the exchange. The problem's folder contains
///   graph.g2o      vertices 0, 1, ... in the order of the keyframes, then the odometry edges, then
///                  the closures; g2o's conventions (formats/g2o.hpp)
///   keyframes.txt  TUM: stamp x y z qx qy qz qw, before correction
///   frames.txt     TUM: tracked poses between the keyframes; may be empty
///   problem.json   {exchange: 1, keyframes, frames, odometry: numbers of lines, planar,
///   similarity,
///                  ids, stamps, closures: [[from, to], ...], units: {...}}
/// and nothing of the reference. The program writes a TUM or g2o file as its result, and if it
/// wants RESULT.json next to it: {status: ok | declined | failed, why, seconds, iterations, counts:
/// {name: number}, phases: {name: seconds}, notes: [text]}, every key optional.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/report.hpp"

namespace loopbench::harness {

inline constexpr int kExchangeVersion = 1;

/// A method's time is the wall time from handing over the problem to receiving the result. Apart
/// from it, as phases of the report: the start of a program that serves and writing, reading and
/// checking files; and, if the time is the program's own statement, the wall time of its run.
inline constexpr const char* kExchangePhase = "start and exchange";
inline constexpr const char* kWallPhase = "from start to end of the program";

/// Counts of a report that are measured, so that they differ between runs.
inline constexpr const char* kProgramTime = "program_cpu_seconds";
inline constexpr const char* kProgramMemory = "program_memory";  ///< largest resident size [bytes]

/// What programs have cost a method, as loopbench measures it. Kept apart from reports, which
/// programs and plugins write.
struct ProgramCosts {
  bool is_measured = false;  ///< a program has run
  double cpu_seconds = 0.0;
  std::int64_t peak_memory = 0;      ///< largest resident size [bytes]
  double exchange_seconds = 0.0;     ///< kExchangePhase
  std::optional<double> stated_run;  ///< kWallPhase; none: no time is a statement
};

/// Of this thread; methods that run programs add to it.
ProgramCosts& program_costs();

/// Adds the costs of one run or answer of a program.
void add_costs(double cpu_seconds, std::int64_t peak_memory);

/// Removes counts and phases with the names above from the report of a method, with a note, and
/// adds program_costs(), which it resets.
void settle_costs(methods::Report& report);

/// Poses of a result: keyframes only, or any stamps that cover them.
enum class ResultPoses { keyframes, dense };
inline auto choices(ResultPoses) {
  return std::array{std::pair{"keyframes", ResultPoses::keyframes},
                    std::pair{"dense", ResultPoses::dense}};
}

/// Writes the four files into an existing folder. Throws InputError if that fails.
void write_problem(const std::filesystem::path& folder, const Problem& problem);

/// Reads poses from `file` and checks them against the problem: number, stamps (at most 1e-4 s
/// apart, replaced by those of the keyframes), finite values. Throws std::runtime_error with the
/// name "result" instead of the path.
Trajectory read_result(const std::filesystem::path& file,
                       const Problem& problem,
                       ResultPoses poses);

/// The same checks for poses from memory; `name` is used in messages.
Trajectory checked_result(Trajectory poses,
                          const Problem& problem,
                          ResultPoses expected,
                          const std::string& name);

/// What a program states about its run.
struct ResultMetadata {
  std::string status = "ok";
  std::string why;
  double seconds = -1.0;  ///< time of the method; negative: not stated
  methods::Report report;
};

/// Reads the text of result.json. Throws std::runtime_error if it is invalid or has another key.
ResultMetadata parse_metadata(const std::string& json);

/// Throws std::runtime_error "WHERE: found key 'x', expected ..." for another key than `known`.
void require_keys(const nlohmann::json& object,
                  const std::vector<std::string>& known,
                  const std::string& where);

/// Throws Undefined with the program's reason if it declined, std::runtime_error if it failed.
void require_ok(const ResultMetadata& metadata);

/// Adds its counts, phases and notes to `report`.
void add_statements(methods::Report& report, const ResultMetadata& metadata);

/// The time of a program that was started for one problem [s]: as it states it, without its start,
/// if that is at most the `wall` time, which is then added to program_costs(); otherwise the wall
/// time.
double time_of_run(methods::Report& report, const ResultMetadata& metadata, double wall);

}  // namespace loopbench::harness
