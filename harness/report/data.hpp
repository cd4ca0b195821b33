/// Data for the report's figures, as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "harness/report/report.hpp"

namespace loopbench::harness {

/// {methods, styles, default_methods, oracle, sequences, baseline, statistics, kinds, cells}: every
/// score of every cell to five digits. styles: {color, dash} of each method as in `plot`;
/// default_methods: indices of the methods that are shown first. A cell is {sequence, method,
/// repeat, ms, values}: indices of its sequence and method, repeat, time [ms], and for each kind
/// null or its statistics.
nlohmann::json scores_json(const ReportContent& content);

/// Amount of trace data in the report.
struct Thinning {
  std::size_t points = 0;   ///< maximum per cell
  std::size_t repeats = 1;  ///< of each sequence, the first ones

  bool operator==(const Thinning&) const = default;
};

/// As much as takes about `bytes`: at most all repeats with as many points as a screen shows. Takes
/// repeats away while a cell would have fewer points than a smooth curve needs. The least amount is
/// one repeat with kLeastPoints (drawn.cpp).
Thinning thinning_for(const ReportContent& content, double bytes);

/// {sequences, grids, cells} from the traces. Sequences: reference, and closures by repeat.
/// Cells: grid, errors and sections of the path; the evaluation times of a cell are in its grid,
/// which cells share.
nlohmann::json traces_json(const ReportContent& content, const Thinning& thinning);

}  // namespace loopbench::harness
