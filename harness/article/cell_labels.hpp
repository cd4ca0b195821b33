/// Labels and cells of a page's table.
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "harness/article/paper_run.hpp"

namespace loopbench::harness {

/// Label of the dataset.
inline std::string dataset_of(const PaperCell& cell) {
  return cell.input.empty() ? cell.sequence : cell.sequence + " " + cell.input;
}

/// Label of the method.
inline std::string method_of(const PaperCell& cell) {
  if (cell.reading.empty() || cell.variant.empty()) return cell.reading + cell.variant;
  return cell.reading + " " + cell.variant;
}

/// Names of all cells, each once, in order.
inline std::vector<std::string> distinct(const std::vector<PaperCell>& cells,
                                         std::string (*name)(const PaperCell&)) {
  std::vector<std::string> out;
  for (const PaperCell& cell : cells) {
    if (std::ranges::count(out, name(cell)) == 0) out.push_back(name(cell));
  }
  return out;
}

/// The cell of this dataset and method; nullptr without one.
inline const PaperCell* cell_of(const std::vector<PaperCell>& cells,
                                const std::string& dataset,
                                const std::string& method) {
  const auto it = std::ranges::find_if(cells, [&](const PaperCell& cell) {
    return dataset_of(cell) == dataset && method_of(cell) == method;
  });
  return it == cells.end() ? nullptr : &*it;
}

/// Dense 3-D ATE [m]; NaN without one.
inline double dense_ate(const PaperCell* cell) {
  const auto ate = cell ? ate_3d(*cell, metrics::Times::dense) : std::nullopt;
  return ate ? *ate : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace loopbench::harness
