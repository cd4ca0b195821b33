/// Checks for estimates and sections that are not finite.
#pragma once

#include "datasets/core/curve.hpp"
#include "datasets/core/sequence.hpp"
#include "harness/model/sweep.hpp"
#include "methods/report.hpp"

namespace loopbench::harness {

/// Throws std::runtime_error if the curve is not finite at a keyframe or, in dense evaluation, at a
/// reference stamp within its span; the message gives the count and the first stamp. Samples the
/// curve once for the keyframes and once for each time offset of the protocols.
void require_finite(const Curve& curve, const Sequence& sequence, const Sweep& sweep);

/// Throws std::runtime_error for a section with stamps that are not finite; the message gives the
/// first. All sections are removed then, because such stamps cannot be stored.
void require_finite_sections(methods::Report& report);

}  // namespace loopbench::harness
