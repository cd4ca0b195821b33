/// Corrector and smoother as one method.
#pragma once

#include "methods/method.hpp"

namespace loopbench {

/// The problem with its keyframes replaced. Tracked frames ride along: each keeps its place
/// relative to the keyframes around it, blended by time. Edges are kept as measured.
/// Complexity O(keyframes + frames).
Problem with_keyframes(const Problem& problem, Trajectory keyframes);

/// `corrector`, then `smoother` on what it made. Either may be null: no correction, polyline.
/// Throws std::runtime_error when the corrector changes the number of keyframes or their stamps.
std::unique_ptr<const Method> compose(std::unique_ptr<const Corrector> corrector,
                                      std::unique_ptr<const Smoother> smoother);

}  // namespace loopbench
