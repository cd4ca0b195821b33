/// Columns of the tables of a store, for copying rows between stores.
#pragma once

#include <utility>

namespace loopbench::harness {

/// Of the table cell, except id, position and digest.
inline constexpr const char* kCellColumns =
    "key, build, sequence_key, provenance_key, sequence, repeat, method, dataset_options, "
    "method_options, closures, oracle_closures, oracle, worker, runs, seconds_median, seconds_min, "
    "seconds_max, "
    "cpu_seconds_median, peak_memory, added_memory, allocations, status, signal, why, "
    "failed_scores, score_digest, phase_digest, count_digest, note_digest, section_digest, "
    "trace_digest";

/// The tables of a cell's rows except its scores, with their columns except `cell`.
inline constexpr std::pair<const char*, const char*> kDetails[] = {
    {"phase", "name, seconds"},
    {"count", "name, value"},
    {"note", "text"},
    {"section", "kind, begin_stamp, end_stamp, what"},
    {"trace", "times, samples"}};

}  // namespace loopbench::harness
