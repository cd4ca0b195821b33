/// Estimates that no metric can judge.
#pragma once

#include "datasets/core/curve.hpp"
#include "datasets/core/sequence.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench {

/// Throws std::runtime_error when the curve is not finite at a keyframe or, where the sweep judges
/// densely, at a reference stamp within its span: at how many, and the first. One sampling of the
/// curve for the keyframes and one for each time offset of the protocols.
void require_finite(const Curve& curve, const Sequence& sequence, const Sweep& sweep);

}  // namespace loopbench
