/// Whether two files have a common time, and what pairs more of their poses.
#pragma once

#include <string>

#include "datasets/core/trajectory.hpp"
#include "datasets/formats/formats.hpp"
#include "harness/commands/eval/arguments.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench::harness {

/// Error if the files have no common time, since numbers and stamps, or numbers of other rows,
/// would be paired by chance; otherwise empty. Accepted are pairs by index, a stated period beside
/// stamps, and a stated offset between files without stamps.
std::string why_two_clocks(const EvalArguments& arguments,
                           const metrics::Protocol& rules,
                           const FileClock& reference,
                           const FileClock& estimate);

/// Options with the numbers of pairs under them, if they pair at least twice as many poses as
/// `rules`: other clocks, a larger difference of stamps, interpolation. Starts with "; "; empty:
/// none. O((n + m) log(n + m)).
std::string pairing_remedies(const Trajectory& reference,
                             const Trajectory& estimate,
                             const metrics::Protocol& rules);

/// The same where `rules` pair no pose, otherwise empty.
std::string remedies_without_pairs(const Trajectory& reference,
                                   const Trajectory& estimate,
                                   const metrics::Protocol& rules);

}  // namespace loopbench::harness
