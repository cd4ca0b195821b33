/// HTML page of one evaluation.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/tables/pivot.hpp"

namespace loopbench::harness {

/// An SVG text with its heading.
struct PageImage {
  std::string heading;
  std::string svg;
};

/// Writes one file without scripts or links: tables, text, and images. Throws InputError.
void write_eval_report(const std::filesystem::path& file,
                       const std::string& reference,
                       const std::vector<Table>& tables,
                       const std::string& text,
                       const std::vector<PageImage>& images);

}  // namespace loopbench::harness
