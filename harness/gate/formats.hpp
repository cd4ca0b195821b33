/// Reading and writing of baselines; reports of the gate as text.
#pragma once

#include <filesystem>
#include <string>

#include "harness/gate/check.hpp"

namespace loopbench::harness {

/// Incremented when the contents of a baseline change.
inline constexpr int kBaselineFormat = 4;

/// JSON with one line per cell: definitions of sequences, protocols, metrics and methods, limits,
/// the list of scores, then for every cell the pose pairs, counts and statistics in that order, in
/// full precision; null if a score is missing or has no number. `statuses` only if some score is
/// not ok; `possible` and `counts` only if they differ from `pairs`.
std::string json(const Baseline& baseline);

/// Hash of all that a baseline's JSON contains, except its limits, which users edit, and `digest`,
/// which is this hash. Throws nlohmann::json::exception if it is not a JSON object.
std::string digest_of(const std::string& text);

/// Throws InputError for a file that was changed since it was written (see digest_of), and
/// `file:line:` for invalid JSON, `file: cells[3].rmse:` for an invalid baseline.
Baseline parse_baseline(const std::string& text, const std::string& file);
Baseline read_baseline(const std::filesystem::path& file);

/// Only the limits, for any format of the rest of the file.
std::vector<Tolerance> read_limits(const std::filesystem::path& file);

/// Verdict and table of findings.
std::string markdown(const GateReport& report, const std::string& sweep);

/// JUnit test suite with one case per cell of the baseline, failed if it has a regression, and one
/// for each regression over all runs. Escaped for XML 1.0.
std::string junit(const GateReport& report, const std::string& sweep);

}  // namespace loopbench::harness
