/// Reading and writing of baselines.
#pragma once

#include <filesystem>
#include <string>

#include "harness/compare/gate.hpp"

namespace loopbench::harness {

/// Incremented when the contents of a baseline change.
inline constexpr int kBaselineFormat = 5;

/// JSON with one line per cell: definitions of sequences, protocols, metrics and methods, limits,
/// the list of scores, then for every cell the pose pairs, counts and statistics in that order;
/// null if a score is missing or has no number. `statuses` only if some score is not ok; `possible`
/// and `counts` only if they differ from `pairs`; all of these as [[value, repetitions], ...].
/// Statistics have the digits that the limits can see: their errors are up to a thousandth of the
/// smallest limit (`precision`).
std::string json(const Baseline& baseline);

/// Hash of all that a baseline's JSON contains, except its limits, which users edit, and `digest`,
/// which is this hash. Throws nlohmann::json::exception if it is not a JSON object.
std::string digest_of(const std::string& text);

/// Throws InputError for a file that was changed since it was written (see digest_of), for limits
/// less than ten times its precision, and
/// `file:line:` for invalid JSON, `file: cells[3].rmse:` for an invalid baseline.
Baseline parse_baseline(const std::string& text, const std::string& file);
Baseline read_baseline(const std::filesystem::path& file);

/// Only the limits, for any format of the rest of the file.
std::vector<Tolerance> read_limits(const std::filesystem::path& file);

}  // namespace loopbench::harness
