/// Costs in the format of Google Benchmark.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/sweep/model/record.hpp"

namespace loopbench::harness {

/// JSON as of Google Benchmark 1.7, which its compare.py reads. A benchmark "SEQUENCE/METHOD" for
/// each timed cell, whose repeats are its repetitions: real_time and cpu_time are medians [us],
/// iterations the timed runs; further keys: least time and variation of the processor time, peak
/// memory [bytes]. "METHOD/FAMILY_BigO" and "_RMS" for each of growths(), with "N^1.03". Failed
/// cells have error_message. `provenance` becomes the context, with the `notes` of the runs as
/// texts, if there are any.
std::string benchmark_json(const std::vector<CellRow>& cells,
                           const std::map<std::string, std::string>& provenance,
                           const std::vector<std::string>& notes = {});

}  // namespace loopbench::harness
