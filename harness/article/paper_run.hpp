/// Runs every input and reading of the reproduction once, for tables, claims and figures.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/execution/run/sequences.hpp"
#include "harness/model/result.hpp"

namespace loopbench::harness {

/// One method on one run, identified by config labels: "fr1_room closed", "text N4 parabola".
struct PaperCell {
  std::string sequence;  ///< first word of the dataset's label: fr1_room | fr3_office
  std::string input;     ///< the other words, the run: closed, open, ...
  std::string reading;   ///< interpretation of the article, or the whole label without N or M;
                         ///< empty for ORB_SLAM2
  std::string variant;   ///< ORB_SLAM2, or N or M with the curve: "N4 parabola", "M6"; or empty
  CellResult result;
  Trajectory keyframes;       ///< keyframes of the run, aligned to the reference like `dense`
  metrics::Evaluation dense;  ///< at the reference's stamps; empty if the cell failed
  double roughness = 0;       ///< RMS second difference of the dense positions over dt^2 [m/s^2]

  bool is_baseline() const { return variant == "ORB_SLAM2"; }
};

/// Reading whose curve is the natural cubic spline through the keyframes, without N or M.
inline const std::string kNaturalSpline = "natural spline";

/// One axis of the article's tables; all in metres.
struct AxisNumbers {
  double max = 0.0;
  double min = 0.0;
  double mean = 0.0;
  double ate = 0.0;  ///< rmse
  double rpe = 0.0;  ///< rmse over one keyframe, in the world frame
};

/// Runs all cells and calls `finished` after each, which may free parts of it. Throws InputError
/// for missing data.
std::vector<PaperCell> run_paper(const Sweep& sweep,
                                 const Catalogue& catalogue,
                                 const DataRoot& root,
                                 const std::function<void(PaperCell&)>& finished);

/// Statistics of a metric with this label, or null.
const metrics::Statistics* find_score(const PaperCell& cell,
                                      const std::string& label,
                                      const std::string& axis,
                                      metrics::Times times,
                                      const std::string& relation = "translation");

/// nullopt if the cell has no such scores.
std::optional<AxisNumbers> axis_numbers(const PaperCell& cell,
                                        const std::string& axis,
                                        metrics::Times times);

/// 3-D rmse at `times` [m], or nullopt.
std::optional<double> ate_3d(const PaperCell& cell, metrics::Times times);

/// The cell of the same run with this reading and variant, or null. The reading is ignored for
/// ORB_SLAM2; "N4" stands for the first variant of that N.
const PaperCell* find_cell(const std::vector<PaperCell>& cells,
                           const PaperCell& like,
                           const std::string& reading,
                           const std::string& variant);

}  // namespace loopbench::harness
