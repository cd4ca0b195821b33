#include "harness/article/heat_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/article/verdict.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench::harness {
namespace {

constexpr int kCellWidth = 72, kCellHeight = 30, kLeft = 110, kTop = 64, kBottom = 24;

std::string heat_color(double value, double largest) {
  if (!std::isfinite(value)) return "#ffffff";
  const double share = largest > 0.0 ? std::min(std::abs(value) / largest, 1.0) : 0.0;
  const int faded = static_cast<int>(std::lround(255.0 * (1.0 - 0.75 * share)));
  return value >= 0.0 ? fmt::format("#{:02x}{:02x}ff", faded, faded)
                      : fmt::format("#ff{:02x}{:02x}", faded, faded);
}

std::string svg_text(int x, int y, const char* anchor, const std::string& text) {
  return fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, text);
}

std::string svg_of(const HeatMap& map, int top) {
  double largest = 0.0;
  for (const auto& row : map.values) {
    for (const double v : row) {
      if (std::isfinite(v)) largest = std::max(largest, std::abs(v));
    }
  }
  std::string out = svg_text(8, top + 16, "start", map.title);
  out += svg_text(kLeft, top + 38, "start", map.column_title);
  out += svg_text(8, top + 56, "start", map.row_title);
  for (std::size_t c = 0; c < map.columns.size(); ++c) {
    out += svg_text(kLeft + static_cast<int>(c) * kCellWidth + kCellWidth / 2,
                    top + 56,
                    "middle",
                    map.columns[c]);
  }
  for (std::size_t r = 0; r < map.rows.size(); ++r) {
    const int y = top + kTop + static_cast<int>(r) * kCellHeight;
    out += svg_text(kLeft - 8, y + 20, "end", map.rows[r]);
    for (std::size_t c = 0; c < map.columns.size(); ++c) {
      const int x = kLeft + static_cast<int>(c) * kCellWidth;
      const double v = map.values[r][c];
      out += fmt::format(
          "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\" stroke=\"#999999\"/>\n",
          x,
          y,
          kCellWidth,
          kCellHeight,
          heat_color(v, largest));
      if (std::isfinite(v)) out += svg_text(x + kCellWidth / 2, y + 20, "middle", signed_tenths(v));
    }
  }
  return out;
}

}  // namespace

std::string heat_table(const HeatMap& map) {
  std::string out = fmt::format("\n| {} \\ {} |", map.row_title, map.column_title);
  std::string rule = "| ---: |";
  for (const std::string& column : map.columns) {
    out += fmt::format(" {} |", column);
    rule += " ---: |";
  }
  out += "\n" + rule + "\n";
  for (std::size_t r = 0; r < map.rows.size(); ++r) {
    out += fmt::format("| {} |", map.rows[r]);
    for (const double v : map.values[r]) {
      out += std::isfinite(v) ? " " + signed_tenths(v) + " |" : " |";
    }
    out += "\n";
  }
  return out;
}

void write_heat_maps(const std::filesystem::path& file, const std::vector<HeatMap>& maps) {
  int height = 0, width = 0;
  std::string body;
  for (const HeatMap& map : maps) {
    body += svg_of(map, height);
    height += kTop + static_cast<int>(map.rows.size()) * kCellHeight + kBottom;
    width = std::max(width, kLeft + static_cast<int>(map.columns.size()) * kCellWidth + 16);
  }
  write_result(file,
               fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
                           "viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\" font-size=\"13\">\n"
                           "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
                           width,
                           height) +
                   body + "</svg>\n");
}

}  // namespace loopbench::harness
