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
/// file, also those that are not used. `anchors`: those of the file, sorted by keyframe; the lines
/// of the indices `dropped` (ascending) are left out. O(size of the file).
inline std::vector<std::string> prior_lines(const std::filesystem::path& path,
                                            const std::vector<std::int64_t>& ids,
                                            const std::vector<Anchor>& anchors,
                                            const std::vector<std::size_t>& dropped) {
  std::vector<std::string> out, priors;
  std::vector<std::size_t> passed(ids.size(), 0);  // lines of each vertex
  const auto is_dropped = [&](std::size_t vertex) {
    const auto first = std::ranges::lower_bound(anchors, vertex, {}, &Anchor::keyframe);
    const auto index = static_cast<std::size_t>(first - anchors.begin()) + passed[vertex]++;
    return std::ranges::binary_search(dropped, index);
  };
  TextFile file(path);
  for (Line line; file.next(line);) {
    Columns columns(file, line);
    const std::string_view word = columns.word();
    if (word.starts_with("PARAMS")) out.emplace_back(line.text);
    const bool is_anchor = std::ranges::find(kPriorTags, word, &PriorTag::word) != kPriorTags.end();
    if (!is_anchor && !word.starts_with("EDGE_SE3_PRIOR")) continue;
    const std::int64_t id = columns.integer("id");
    const auto found = std::ranges::lower_bound(ids, id);
    if (found == ids.end() || *found != id) continue;
    if (is_anchor && is_dropped(static_cast<std::size_t>(found - ids.begin()))) continue;
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

/// Lines of the priors of a graph without those of `dropped` anchors: of the file, or in a graph in
/// JSON of its `anchors`.
inline std::vector<std::string> prior_lines(const std::filesystem::path& path,
                                            const PoseGraph& written,
                                            const std::vector<Anchor>& anchors,
                                            const std::vector<std::size_t>& dropped = {}) {
  if (!is_json_graph(path)) return prior_lines(path, written.ids, anchors, dropped);
  std::vector<Anchor> kept;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    if (!std::ranges::binary_search(dropped, i)) kept.push_back(anchors[i]);
  }
  return prior_lines(kept, written.ids, written.planar);
}

}  // namespace loopbench
