#include "harness/answers/report/curve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace loopbench::harness {
namespace {

constexpr double kDeviation = 1e-3;  // of the largest extent: half a line width

/// Positions of a curve.
struct CurveLine {
  std::vector<const double*> axes;
  double largest = 0.0;  ///< deviation

  explicit CurveLine(const DrawnCurve& curve, std::size_t rows) {
    for (const char* name : {"x", "y", "z"}) {
      const auto found = curve.columns.find(name);
      if (found == curve.columns.end() || found->second.size() != rows) continue;
      axes.push_back(found->second.data());
      const auto [low, high] = std::ranges::minmax(found->second);
      largest = std::max(largest, kDeviation * (high - low));
    }
  }

  /// Distance of row k from the line between rows a and b.
  double distance(std::size_t a, std::size_t b, std::size_t k) const {
    double along = 0.0, length = 0.0, square = 0.0;
    for (const double* axis : axes) {
      const double line = axis[b] - axis[a], from = axis[k] - axis[a];
      along += line * from;
      length += line * line;
      square += from * from;
    }
    if (length == 0.0) return std::sqrt(square);
    const double u = std::clamp(along / length, 0.0, 1.0);
    return std::sqrt(std::max(0.0, square - 2.0 * u * along + u * u * length));
  }

  /// Adds the rows between a and b without which some would be too far (Douglas and Peucker 1973).
  void add_between(std::size_t a, std::size_t b, std::vector<std::size_t>& kept) const {
    std::vector<std::pair<std::size_t, std::size_t>> open{{a, b}};
    while (!open.empty()) {
      const auto [from, to] = open.back();
      open.pop_back();
      double most = largest;
      std::size_t farthest = from;
      for (std::size_t k = from + 1; k < to; ++k) {
        const double found = distance(from, to, k);
        if (found <= most) continue;
        most = found;
        farthest = k;
      }
      if (farthest == from) continue;
      kept.push_back(farthest);
      open.emplace_back(from, farthest);
      open.emplace_back(farthest, to);
    }
  }
};

void sort_unique(std::vector<std::size_t>& rows) {
  std::ranges::sort(rows);
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
}

}  // namespace

void thin(DrawnCurve& curve, const std::vector<std::string>& peaks) {
  if (std::exchange(curve.is_thin, true)) return;
  const std::size_t rows = curve.columns.empty() ? 0 : curve.columns.begin()->second.size();
  if (rows <= kMostRows) return;
  std::vector<std::size_t> kept = subsampled_indices(rows, kMostRows);
  std::vector<const double*> columns;
  for (const std::string& name : peaks) columns.push_back(curve.columns.at(name).data());
  const CurveLine path(curve, rows);
  columns.insert(columns.end(), path.axes.begin(), path.axes.end());
  for (std::size_t k = 0; k + 1 < kMostRows; ++k) {
    for (const double* values : columns) {
      const double* const end = values + kept[k + 1] + 1;
      for (const double* peak :
           {std::min_element(values + kept[k], end), std::max_element(values + kept[k], end)}) {
        kept.push_back(static_cast<std::size_t>(peak - values));
      }
    }
  }
  sort_unique(kept);
  const std::size_t count = kept.size();
  for (std::size_t k = 0; k + 1 < count; ++k) path.add_between(kept[k], kept[k + 1], kept);
  sort_unique(kept);
  for (auto& [name, values] : curve.columns) {
    if (values.size() != rows) continue;
    for (std::size_t k = 0; k < kept.size(); ++k) values[k] = values[kept[k]];
    values.resize(kept.size());
  }
}

}  // namespace loopbench::harness
