#include "harness/sweep/model/kept_rows.hpp"

#include <bit>
#include <cmath>

namespace loopbench::harness {
namespace {

/// Distance of row k from the line between rows a and b; NaN if one of them is not drawn.
double distance(const DrawnLine& line, std::size_t a, std::size_t b, std::size_t k) {
  double along = 0.0, length = 0.0, square = 0.0;
  for (const std::span<const double> axis : line.axes) {
    const double whole = axis[b] - axis[a], from = axis[k] - axis[a];
    along += whole * from;
    length += whole * whole;
    square += from * from;
  }
  if (length == 0.0) return std::sqrt(square);
  const double u = std::clamp(along / length, 0.0, 1.0);
  const double found = square - 2.0 * u * along + u * u * length;
  return std::isnan(found) ? found : std::sqrt(std::max(0.0, found));
}

bool is_drawn(const DrawnLine& line, std::size_t row) {
  return std::ranges::none_of(line.axes, [&](const auto& axis) { return std::isnan(axis[row]); });
}

/// Adds the rows on both sides of each interruption.
void add_ends(const DrawnLine& line, std::vector<std::size_t>& kept) {
  const std::size_t rows = line.axes.empty() ? 0 : line.axes.front().size();
  for (std::size_t k = 1; k < rows; ++k) {
    if (is_drawn(line, k) != is_drawn(line, k - 1)) kept.insert(kept.end(), {k - 1, k});
  }
}

struct Part {
  std::size_t from, to, depth;
};

/// The row of a part that is farthest from a line, in shares of its deviation; `from` if none is
/// farther than that.
std::size_t farthest(const std::vector<DrawnLine>& lines, const Part& part) {
  std::size_t out = part.from;
  double most = 1.0;
  for (const DrawnLine& line : lines) {
    for (std::size_t k = part.from + 1; k < part.to; ++k) {
      const double found = distance(line, part.from, part.to, k) / line.deviation;
      if (!(found > most)) continue;
      most = found;
      out = k;
    }
  }
  return out;
}

}  // namespace

void sort_unique(std::vector<std::size_t>& rows) {
  std::ranges::sort(rows);
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
}

void keep_deviating(std::vector<std::size_t>& kept, const std::vector<DrawnLine>& lines) {
  if (kept.size() < 2) return;
  for (const DrawnLine& line : lines) add_ends(line, kept);
  sort_unique(kept);
  const auto most_splits = 3 * static_cast<std::size_t>(std::bit_width(kept.back()));
  std::vector<Part> open;
  for (std::size_t i = 0; i + 1 < kept.size(); ++i) open.push_back({kept[i], kept[i + 1], 0});
  while (!open.empty()) {
    const Part part = open.back();
    open.pop_back();
    std::size_t row = farthest(lines, part);
    if (row == part.from) continue;
    if (part.depth > most_splits) row = part.from + (part.to - part.from) / 2;
    kept.push_back(row);
    open.push_back({part.from, row, part.depth + 1});
    open.push_back({row, part.to, part.depth + 1});
  }
  sort_unique(kept);
}

}  // namespace loopbench::harness
