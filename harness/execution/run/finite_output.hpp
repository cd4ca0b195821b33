/// Check for estimates that are not finite.
#pragma once

#include "datasets/core/curve.hpp"
#include "datasets/core/sequence.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Throws std::runtime_error if the curve is not finite at a keyframe or, in dense evaluation, at a
/// reference stamp within its span; the message gives the count and the first stamp. Samples the
/// curve once for the keyframes and once for each time offset of the protocols.
void require_finite(const Curve& curve, const Sequence& sequence, const Sweep& sweep);

}  // namespace loopbench::harness
