/// Step 6: which nodes are fitted together, and which part of the curve each fit speaks for.
#pragma once

#include "methods/smoothers/manifold/nodes.hpp"

namespace loopbench::manifold {

struct Window {
  NodeRange fitted;  ///< nodes the curve is fitted to
  NodeRange owned;   ///< part of the trajectory it stands for; inside `fitted`

  bool operator==(const Window&) const = default;
};

/// Windows of `size` nodes over one segment, consecutive ones share their end node, the last
/// re-uses earlier nodes. A segment shorter than that borrows nodes from its neighbours, the
/// earlier and the later in turn. Fewer only when the trajectory has fewer (`count` nodes).
/// `segment` has two nodes or more, `size` >= 2. O(windows).
std::vector<Window> windows(NodeRange segment, std::size_t size, std::size_t count);

}  // namespace loopbench::manifold
