#include "methods/smoothers/manifold/short_segments.hpp"

#include <cmath>

#include "methods/smoothers/manifold/quasi_keyframes.hpp"

namespace loopbench::manifold {

std::vector<NodeRange> merged(const Nodes& nodes, std::vector<NodeRange> runs, std::size_t least) {
  std::vector<double> ways(nodes.size(), 0.0);
  for (std::size_t i = 1; i < nodes.size(); ++i) ways[i] = ways[i - 1] + nodes.step(i - 1).norm();
  const auto speed = [&](const NodeRange& run) {
    return (ways[run.last] - ways[run.first]) / (nodes.stamps[run.last] - nodes.stamps[run.first]);
  };
  std::vector<NodeRange> out;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const NodeRange& run = runs[k];
    const bool next = k + 1 < runs.size();
    if (run.nodes() >= least || (out.empty() && !next)) {
      out.push_back(run);
      continue;
    }
    const bool forth = out.empty() || (next && std::abs(speed(runs[k + 1]) - speed(run)) <
                                                   std::abs(speed(out.back()) - speed(run)));
    if (forth) {
      runs[k + 1].first = run.first;
    } else {
      out.back().last = run.last;
    }
  }
  return out;
}

Filled filled(const Trajectory& nodes,
              const std::vector<NodeRange>& runs,
              const Trajectory& frames,
              std::size_t least) {
  Filled out;
  out.nodes.push_back(nodes.front());
  for (const NodeRange& run : runs) {
    const std::size_t first = out.nodes.size() - 1;
    const std::size_t edges = run.last - run.first;
    const std::size_t parts = run.nodes() < least ? (least - 2 + edges) / edges : 1;
    for (std::size_t i = run.first; i < run.last; ++i) {
      out.inserted += insert_frames(nodes[i], nodes[i + 1], parts, frames, out.nodes);
      out.nodes.push_back(nodes[i + 1]);
    }
    out.runs.push_back({first, out.nodes.size() - 1});
  }
  return out;
}

}  // namespace loopbench::manifold
