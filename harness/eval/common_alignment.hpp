/// One alignment for several estimates that share a frame: robots, submaps, mapping runs.
#pragma once

#include <vector>

#include "harness/eval/recorded_sweep.hpp"

namespace loopbench::harness {

/// For each run of the sweep, the alignment under each protocol, by least squares over the pairs of
/// all estimates of its group: all files if there is one reference, otherwise the runs of equal
/// name of one method. Files that cannot be read, or have no pairs, do not contribute. Throws
/// InputError for protocols without a least-squares alignment of all pairs, and if a group does not
/// determine it. O(n log n); files are read once more.
std::vector<std::vector<metrics::Alignment>> common_alignments(const RecordedSweep& files);

}  // namespace loopbench::harness
