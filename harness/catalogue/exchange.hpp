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

#include <filesystem>
#include <map>
#include <string>

#include "datasets/core/problem.hpp"
#include "methods/report.hpp"

namespace loopbench::harness {

inline constexpr int kExchangeVersion = 1;

/// Phase of a report: time that starting a program and exchanging files took. It is not part of the
/// method's time.
inline constexpr const char* kExchangePhase = "start and exchange";

/// Whether a program computed the result.
bool uses_exchange(const methods::Report& report);

/// Sum of these phases [s].
double exchange_seconds(const methods::Report& report);

/// Counts of a report that are measured, so that they differ between runs.
inline constexpr const char* kProgramTime = "program_cpu_seconds";
inline constexpr const char* kProgramMemory = "program_memory";  ///< largest resident size [bytes]

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

/// Reads the text of result.json. Throws std::runtime_error if it is invalid.
ResultMetadata parse_metadata(const std::string& json);

/// Throws Undefined with the program's reason if it declined, std::runtime_error if it failed.
void require_ok(const ResultMetadata& metadata);

/// Adds its counts, phases and notes to `report`. Returns the method's time: as stated by the
/// program if that is at most the `measured` time, otherwise that one, with a note of what it is
/// ("from request to answer") [s].
double add_statements(methods::Report& report,
                      const ResultMetadata& metadata,
                      double measured,
                      const char* measured_from);

}  // namespace loopbench::harness
