/// Every input and reading of the reproduction, run once and kept for tables, claims and figures.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/execution/run/sequences.hpp"
#include "harness/model/result.hpp"

namespace loopbench {

/// One method on one input. Labels of the config name it: "fr1_room closed", "robust N4".
struct PaperCell {
  std::string sequence;  ///< first word of the dataset's label: fr1_room | fr3_office
  std::string input;     ///< the rest of it: closed, open, ...
  std::string reading;   ///< how the article is read: literal, robust; empty for ORB_SLAM2
  std::string variant;   ///< ORB_SLAM2, N3..N5, M6..M8
  CellResult result;
  Trajectory keyframes;  ///< the input's, moved onto the reference like `dense`
  Evaluation dense;      ///< at the reference's times; empty when the cell failed
  double roughness = 0;  ///< RMS second difference of the dense positions over dt^2 [m/s^2]
};

/// One axis as the article tabulates it; all in metres.
struct AxisNumbers {
  double max = 0.0;
  double min = 0.0;
  double mean = 0.0;
  double ate = 0.0;  ///< rmse
  double rpe = 0.0;  ///< rmse over one keyframe, in the world
};

/// Runs all cells, `finished` after each. Throws InputError for labels it cannot read and for data
/// that is not there.
std::vector<PaperCell> run_paper(const Sweep& sweep,
                                 const Catalogue& catalogue,
                                 const DataRoot& root,
                                 const std::function<void(const PaperCell&)>& finished);

/// Nothing when the cell has no such scores.
std::optional<AxisNumbers> axis_numbers(const PaperCell& cell,
                                        const std::string& axis,
                                        Times times);

/// 3-D rmse at `times` [m], or nothing.
std::optional<double> ate_3d(const PaperCell& cell, Times times);

/// The cell of the same input with this reading and variant, or null. For ORB_SLAM2 the reading is
/// ignored.
const PaperCell* find_cell(const std::vector<PaperCell>& cells,
                           const PaperCell& like,
                           const std::string& reading,
                           const std::string& variant);

}  // namespace loopbench
