/// The article's claims about single segments: which curve fits at which speed and curvature, and
/// that faster segments meet more smoothly.
#pragma once

#include "harness/article/claims.hpp"

namespace loopbench {

/// Judged on the closed run of each sequence, in chord axes whatever the reading.
///
/// "The parabola fits at these speeds": the truth at the keyframes, so that what a family misses is
/// its own doing and not drift. Of all runs of five keyframes whose speeds, and turns per keyframe
/// [rad], lie in the quoted ranges and that are a graph y' = f(x'), each family's rms distance to
/// the truth between the keyframes. Where no five turn as quoted (kappa's unit is unknown) the
/// speeds alone decide; where there are none at these speeds either, it cannot be judged. Holds
/// when the quoted family is the nearest or within 1 % of it, and refused in half of the windows at
/// most.
///
/// "C1 at higher speed": parabolas through three keyframes, laid end to end without any joint; the
/// median angle between neighbouring tangents, in the faster and the slower half of the joints.
/// Holds when the faster half turns by less than a degree and the slower by more.
std::vector<Claim> judge_segment_claims(const std::vector<PaperCell>& cells);

}  // namespace loopbench
