/// Baselines as files, reports of the gate as text.
#pragma once

#include <filesystem>
#include <string>

#include "harness/gate/check.hpp"

namespace loopbench {

/// JSON with a line per cell: what it was made from and by, limits, the list of scores, then for
/// every cell its statistics in that order, in full precision; null where a score is missing, its
/// status in words where it has no number.
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
