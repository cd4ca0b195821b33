/// Baselines as files, reports of the gate as text.
#pragma once

#include <filesystem>
#include <string>

#include "harness/gate/check.hpp"

namespace loopbench {

/// Raised when a baseline has to hold more, or something else.
inline constexpr int kBaselineFormat = 3;

/// JSON with a line per cell: definitions of sequences, protocols, metrics and methods, limits, the
/// list of scores, then for every cell the pose pairs, counts and statistics in that order, in full
/// precision; null where a score is missing or has no number. `statuses` only where some score is
/// not ok; `possible` and `counts` only where they differ from `pairs`.
std::string json(const Baseline& baseline);

/// Throws InputError `file:line:` where it is not JSON, `file: cells[3].rmse:` where it is no
/// baseline.
Baseline parse_baseline(const std::string& text, const std::string& file);
Baseline read_baseline(const std::filesystem::path& file);

/// The limits alone, whatever format the rest of the file has.
std::vector<Tolerance> read_limits(const std::filesystem::path& file);

/// A verdict and a table of findings.
std::string markdown(const GateReport& report, const std::string& sweep);

/// A test suite with a case per cell of the baseline, failed where it has a regression, and one for
/// each regression over all runs. Escaped for XML 1.0.
std::string junit(const GateReport& report, const std::string& sweep);

}  // namespace loopbench
