/// Figures 5 to 8: reference red, ours blue, ORB-SLAM2 green.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/article/paper_run.hpp"

namespace loopbench::harness {

struct PaperFigure {
  std::string file;     ///< name without folder
  std::string caption;  ///< Markdown: the article's caption, and each panel with its numbers
};

/// Writes figure5.svg (fr1) and figure7.svg (fr3): two segments fitted locally with N = 3, 4, 5;
/// and figure6.svg (fr1) and figure8.svg (fr3): the complete run in the xoy plane for N and in xyz
/// for M. All on the closed run in this reading, four keyframes with a parabola. The reference is
/// drawn thickest and ours thinnest, so that coinciding curves are visible; curves are cut where
/// they leave the surroundings of the reference.
std::vector<PaperFigure> paper_figures(const std::vector<PaperCell>& cells,
                                       const std::string& reading,
                                       const std::filesystem::path& folder);

}  // namespace loopbench::harness
