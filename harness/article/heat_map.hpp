/// Heat maps of two swept options.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace loopbench::harness {

/// values[row][column]; NaN is drawn white.
struct HeatMap {
  std::string title;
  std::string row_title, column_title;
  std::vector<std::string> rows, columns;
  std::vector<std::vector<double>> values;
};

/// A Markdown table of the values with one decimal.
std::string heat_table(const HeatMap& map);

/// SVG, one map below the other; blue for positive, red for negative values, on one scale per map.
/// Throws InputError if the file cannot be written.
void write_heat_maps(const std::filesystem::path& file, const std::vector<HeatMap>& maps);

}  // namespace loopbench::harness
