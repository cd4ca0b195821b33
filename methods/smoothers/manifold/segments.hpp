/// Steps 2 and 3: runs of nodes of similar speed without a sharp turn.
#pragma once

#include <optional>

#include "methods/smoothers/manifold/nodes.hpp"

namespace loopbench::manifold {

struct SegmentRule {
  std::optional<double> speed_band;  ///< most max - min speed inside [m/s]; none: the mean speed
  double turn_max = 0.75;            ///< most turning at an inner node, in space [rad]
};

/// Covers all nodes (two at least), left to right. A segment grows while its speeds stay in the
/// band; a turn above the threshold closes it and the turning node opens the next one, which
/// forgets the speeds so far. Source: paper section 3.3; design readings 5.2 and 5.3. O(n).
std::vector<NodeRange> segments(const Nodes& nodes, const SegmentRule& rule);

}  // namespace loopbench::manifold
