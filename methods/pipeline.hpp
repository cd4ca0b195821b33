/// Composes a corrector and a smoother into one method.
#pragma once

#include "methods/method.hpp"

namespace loopbench::methods {

/// Returns the problem with its keyframes replaced. Each tracked frame keeps its pose relative to
/// the two keyframes around it, interpolated by time. Edges are copied unchanged. O(keyframes +
/// frames).
Problem with_keyframes(const Problem& problem, Trajectory keyframes);

/// Returns a method that runs `corrector` and then `smoother` on its result. A null corrector means
/// no correction, a null smoother a polyline. `estimate` throws std::runtime_error when the
/// corrector changes the number of keyframes or their stamps.
std::unique_ptr<const Estimator> compose(std::unique_ptr<const Corrector> corrector,
                                         std::unique_ptr<const Smoother> smoother);

}  // namespace loopbench::methods
