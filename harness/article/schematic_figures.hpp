/// Figures 1 to 4, which the article draws as sketches, from data.
#pragma once

#include <filesystem>
#include <vector>

#include "harness/article/paper_figures.hpp"

namespace loopbench::harness {

/// Writes figure1.svg to figure4.svg: drift and joints (1), real and straight motion between four
/// keyframes with a Frenet frame (2), the candidates of psi at a node (3), binormals at two nodes
/// and the angle between them (4). Figure 1 (a) uses the open run of fr1_room, the others the
/// reference at the keyframes of its closed run, around the inner node with the largest angle
/// between steps. None without these runs.
std::vector<PaperFigure> schematic_figures(const std::vector<PaperCell>& cells,
                                           const std::filesystem::path& folder);

}  // namespace loopbench::harness
