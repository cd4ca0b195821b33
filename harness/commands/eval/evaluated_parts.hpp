/// Evaluation of the parts of an estimate that have a frame of their own: `eval --parts`.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/trajectory.hpp"
#include "harness/commands/eval/evaluate_files.hpp"
#include "metrics/doctor/map_checks.hpp"

namespace loopbench::harness {

/// The parts of `poses`: of `auto` those of metrics::map_parts(); otherwise those of a file with
/// one part per line, its first stamp, or its first and last stamp [s], in the order of time and
/// without common poses. Throws InputError.
std::vector<metrics::RowRange> parts_of(const std::string& rule,
                                        const Trajectory& reference,
                                        const Trajectory& poses,
                                        double offset);

/// The parts as files of their own: NAME_part1.txt. Throws InputError.
std::vector<NamedTrajectory> split_file(const NamedTrajectory& file,
                                        const std::string& rule,
                                        const Trajectory& reference,
                                        double offset);

/// Every part is aligned and evaluated on its own. The results of each estimate are those of its
/// parts, named by their rows, and one over all parts: pooled errors (no median and percentiles),
/// and the coverage of all. Throws InputError.
Evaluations evaluate_parts(const EvalArguments& arguments);

}  // namespace loopbench::harness
