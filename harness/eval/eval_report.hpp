/// HTML page of one evaluation.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/eval/drawn_sequences.hpp"
#include "harness/tables/pivot.hpp"

namespace loopbench::harness {

/// Writes one file without scripts or links: tables, text, and the figures of error_figures() as
/// embedded SVG images. Throws InputError like write_figure().
void write_eval_report(const std::filesystem::path& file,
                       const std::string& reference,
                       const std::vector<Table>& tables,
                       const std::string& text,
                       const std::vector<DrawnRuns>& drawn);

}  // namespace loopbench::harness
