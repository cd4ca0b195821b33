#include "methods/smoothers/manifold/short_segments.hpp"

#include <cmath>

#include "methods/smoothers/manifold/quasi_keyframes.hpp"

namespace loopbench::methods::manifold {

std::vector<NodeRange> merge_short_segments(const Nodes& nodes,
                                            std::vector<NodeRange> runs,
                                            std::size_t min_nodes) {
  std::vector<double> path_length(nodes.size(), 0.0);
  for (std::size_t i = 1; i < nodes.size(); ++i)
    path_length[i] = path_length[i - 1] + nodes.step(i - 1).norm();
  const auto speed = [&](const NodeRange& run) {
    return (path_length[run.last] - path_length[run.first]) /
           (nodes.stamps[run.last] - nodes.stamps[run.first]);
  };
  std::vector<NodeRange> out;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const NodeRange& run = runs[k];
    const bool has_next = k + 1 < runs.size();
    if (run.nodes() >= min_nodes || (out.empty() && !has_next)) {
      out.push_back(run);
      continue;
    }
    const bool with_next =
        out.empty() || (has_next && std::abs(speed(runs[k + 1]) - speed(run)) <
                                        std::abs(speed(out.back()) - speed(run)));
    if (with_next) {
      runs[k + 1].first = run.first;
    } else {
      out.back().last = run.last;
    }
  }
  return out;
}

FilledSegments fill_short_segments(const Trajectory& nodes,
                                   const std::vector<NodeRange>& runs,
                                   const Trajectory& frames,
                                   std::size_t min_nodes) {
  FilledSegments out;
  out.nodes.push_back(nodes.front());
  for (const NodeRange& run : runs) {
    const std::size_t first = out.nodes.size() - 1;
    const std::size_t edges = run.last - run.first;
    const std::size_t parts = run.nodes() < min_nodes ? (min_nodes - 2 + edges) / edges : 1;
    for (std::size_t i = run.first; i < run.last; ++i) {
      out.inserted += insert_frames(nodes[i], nodes[i + 1], parts, frames, out.nodes);
      out.nodes.push_back(nodes[i + 1]);
    }
    out.runs.push_back({first, out.nodes.size() - 1});
  }
  return out;
}

}  // namespace loopbench::methods::manifold
