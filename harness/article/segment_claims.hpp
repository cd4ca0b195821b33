/// The article's claims about single segments: the curve that fits at a given speed and curvature,
/// and smoother joints of faster segments.
#pragma once

#include "harness/article/claims.hpp"

namespace loopbench::harness {

/// Checked on the closed run of each sequence, in chord axes for any reading.
///
/// "The parabola fits at these speeds": uses the reference at the keyframes, so that errors are due
/// to the family and not to drift. Considers all runs of five keyframes whose speeds and rotations
/// per keyframe [rad] lie in the quoted ranges and that are a graph y' = f(x'), and computes each
/// family's rms distance to the reference between the keyframes. If no five keyframes have the
/// quoted rotations (kappa's unit is unknown), only the speeds are used; if there are none with
/// these speeds either, the claim cannot be judged. It holds if the quoted family is the nearest or
/// within 1 % of it, and rejected in at most half of the windows.
///
/// "C1 at higher speed": parabolas through three keyframes, concatenated without blending; the
/// median angle between neighbouring tangents, in the faster and the slower half of the joints. It
/// holds if the angle is less than a degree in the faster half and more in the slower.
std::vector<Claim> check_segment_claims(const std::vector<PaperCell>& cells);

}  // namespace loopbench::harness
