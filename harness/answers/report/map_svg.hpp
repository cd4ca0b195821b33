/// Static maps for pages without scripts.
#pragma once

#include <string>

#include "harness/answers/report/draw.hpp"

namespace loopbench::harness {

/// A figure element: the curves (x, y, z; a gap where they are not finite) in the plane of the
/// largest extent with equal scales, below the title and the note, above a legend. The first curve
/// has the colour of the text. No curve has more points than it is given. O(points).
std::string map_figure(const FigureData& data);

}  // namespace loopbench::harness
