/// Derived records: gain over the baseline; run times and pair counts.
#pragma once

#include <string>
#include <vector>

#include "harness/sweep/model/record.hpp"

namespace loopbench::harness {

/// For every `ate` translation record with a baseline record of the same sequence, repeat, protocol
/// and times: metric `gain`, unit %, each statistic 100 * (1 - value / baseline value). Positive is
/// better; the baseline itself has gain 0. A statistic is NaN if the baseline's value is zero
/// within rounding; the record is declined if that is its RMSE. Gains of several runs are averaged
/// by their ratios (see pivot.hpp). Empty if `baseline` is empty. O(n log n).
std::vector<Record> gains(const std::vector<Record>& records, const std::string& baseline);

/// As gains(), but below zero where the error is lower, as in verdicts: metric `change`.
std::vector<Record> changes(const std::vector<Record>& records, const std::string& baseline);

/// One record per cell, protocol and times: metric `time`, unit ms, every statistic is the median
/// wall time. None of files that `eval --store` evaluated.
std::vector<Record> run_times(const std::vector<Record>& records);

/// The costs of a cell as scores, one record each per cell, protocol and times: its median
/// processor time `cpu_ms`, its median wall time `wall_ms` (the same as `time`) and its peak memory
/// `memory_mb`, with the labels cpu, wall and memory; those that a text of `asked` is or selects:
/// "cpu", "cpu_ms", "metric=cpu_ms".
std::vector<Record> cost_scores(const std::vector<Record>& records,
                                const std::vector<std::string>& asked);

/// Appends gains, run times, cost_scores() of `asked`, and the numbers of pose pairs of the scores
/// (metric `pairs`); `records`: complete sequences.
void add_derived(std::vector<Record>& records,
                 const std::string& baseline,
                 const std::vector<std::string>& asked = {});

}  // namespace loopbench::harness
