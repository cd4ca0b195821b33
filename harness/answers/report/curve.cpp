#include "harness/answers/report/curve.hpp"

#include <algorithm>
#include <utility>

#include "harness/sweep/model/kept_rows.hpp"

namespace loopbench::harness {
namespace {

constexpr double kDeviation = 1e-3;  // of the largest extent: half a line width

/// The positions of a curve.
DrawnLine path_of(const DrawnCurve& curve, std::size_t rows) {
  DrawnLine out;
  for (const char* name : {"x", "y", "z"}) {
    const auto found = curve.columns.find(name);
    if (found == curve.columns.end() || found->second.size() != rows) continue;
    out.axes.emplace_back(found->second);
    const auto [low, high] = std::ranges::minmax(found->second);
    out.deviation = std::max(out.deviation, kDeviation * (high - low));
  }
  return out;
}

}  // namespace

void thin(DrawnCurve& curve, const std::vector<std::string>& peaks) {
  if (std::exchange(curve.is_thin, true)) return;
  const std::size_t rows = curve.columns.empty() ? 0 : curve.columns.begin()->second.size();
  if (rows <= kMostRows) return;
  std::vector<std::size_t> kept = subsampled_indices(rows, kMostRows);
  std::vector<const double*> columns;
  for (const std::string& name : peaks) columns.push_back(curve.columns.at(name).data());
  const DrawnLine path = path_of(curve, rows);
  for (const std::span<const double> axis : path.axes) columns.push_back(axis.data());
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
  keep_deviating(kept, {path});
  for (auto& [name, values] : curve.columns) {
    if (values.size() != rows) continue;
    for (std::size_t k = 0; k < kept.size(); ++k) values[k] = values[kept[k]];
    values.resize(kept.size());
  }
}

}  // namespace loopbench::harness
