/// HTML page of one evaluation.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/eval/drawn_sequences.hpp"

namespace loopbench::harness {

/// Writes one file without scripts or links: the table as text, and the figures of error_figures()
/// as embedded SVG images. Throws InputError like write_figure().
void write_eval_report(const std::filesystem::path& file,
                       const std::string& reference,
                       const std::string& table,
                       const std::vector<DrawnRuns>& drawn);

}  // namespace loopbench::harness
