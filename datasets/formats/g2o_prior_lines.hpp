/// Lines of g2o files that measure positions: those of an input, and of anchors.
#pragma once

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "datasets/formats/g2o_priors.hpp"
#include "datasets/formats/json_graph.hpp"

namespace loopbench {

/// Returns the PARAMS lines, then the priors of the vertices `ids` (ascending) in the order of the
/// file, also those that are not used. O(size of the file).
inline std::vector<std::string> prior_lines(const std::filesystem::path& path,
                                            const std::vector<std::int64_t>& ids) {
  std::vector<std::string> out, priors;
  TextFile file(path);
  for (Line line; file.next(line);) {
    Columns columns(file, line);
    const std::string_view word = columns.word();
    if (word.starts_with("PARAMS")) out.emplace_back(line.text);
    const bool is_prior =
        std::ranges::find(kPriorTags, word, &PriorTag::word) != kPriorTags.end() ||
        word.starts_with("EDGE_SE3_PRIOR");
    if (!is_prior || !std::ranges::binary_search(ids, columns.integer("id"))) continue;
    priors.emplace_back(line.text);
  }
  out.insert(out.end(), priors.begin(), priors.end());
  return out;
}

/// Lines of anchors at the body: EDGE_PRIOR_SE2_XY if `planar`, else EDGE_SE3_PRIORXYZ.
inline std::vector<std::string> prior_lines(const std::vector<Anchor>& anchors,
                                            const std::vector<std::int64_t>& ids,
                                            bool planar) {
  const int size = planar ? 2 : 3;
  std::vector<std::string> out;
  for (const Anchor& anchor : anchors) {
    std::string& line = out.emplace_back(planar ? "EDGE_PRIOR_SE2_XY" : "EDGE_SE3_PRIORXYZ");
    line += " " + std::to_string(ids[anchor.keyframe]);
    const Eigen::MatrixXd information = anchor.covariance.topLeftCorner(size, size).inverse();
    for (int i = 0; i < size; ++i) line += fmt::format(" {}", anchor.position[i]);
    for (int i = 0; i < size; ++i) {
      for (int j = i; j < size; ++j) line += fmt::format(" {}", information(i, j));
    }
  }
  return out;
}

/// Lines of the priors of a graph: of the file, or in a graph in JSON of its `anchors`.
inline std::vector<std::string> prior_lines(const std::filesystem::path& path,
                                            const PoseGraph& written,
                                            const std::vector<Anchor>& anchors) {
  return is_json_graph(path) ? prior_lines(anchors, written.ids, written.planar)
                             : prior_lines(path, written.ids);
}

}  // namespace loopbench
