/// Step 6: which nodes are fitted together, and which part of the curve each fit speaks for.
#pragma once

#include <array>

#include "methods/smoothers/manifold/nodes.hpp"

namespace loopbench::manifold {

/// consecutive: end to end, sharing end nodes. sliding_blend: one for every edge, each blended into
/// the next. one_per_segment: nodes spread evenly over it. first_n: its first nodes speak for all.
/// "We select N keyframe pose nodes in each segment" admits all four.
enum class Scheme { consecutive, sliding_blend, one_per_segment, first_n };
inline auto choices(Scheme) {
  return std::array{std::pair{"consecutive", Scheme::consecutive},
                    std::pair{"sliding_blend", Scheme::sliding_blend},
                    std::pair{"one_per_segment", Scheme::one_per_segment},
                    std::pair{"first_n", Scheme::first_n}};
}

struct Window {
  NodeRange fitted;       ///< nodes the curve is fitted to
  NodeRange owned;        ///< part of the trajectory it stands for; inside `fitted` but for first_n
  std::size_t taken = 0;  ///< as many of the fitted nodes, evenly spread; 0: all of them

  bool operator==(const Window&) const = default;
};

/// Windows of `size` nodes over one segment, consecutive ones share their end node, the last
/// re-uses earlier nodes. A segment shorter than that borrows nodes from its neighbours, the
/// earlier and the later in turn. Fewer only when the trajectory has fewer (`count` nodes).
/// `segment` has two nodes or more, `size` >= 2. O(windows).
std::vector<Window> windows(NodeRange segment,
                            std::size_t size,
                            std::size_t count,
                            Scheme scheme = Scheme::consecutive);

/// The nodes the window is fitted to. O(their number).
std::vector<std::size_t> picked(const Window& window);

}  // namespace loopbench::manifold
