/// Sentences about a judgement of anchors, without the full stop.
#pragma once

#include <string>

#include "datasets/core/problem.hpp"
#include "methods/correctors/consensus/judged_anchors.hpp"

namespace loopbench::methods::consensus {

/// "36 of 40 anchors are used; dropped, with the distance from what the others predict: 24 (18.2
/// m)", those with the most evidence against them first, at most five; why none is used if nothing
/// is decided; "all 40 anchors agree".
std::string anchors_text(const Problem& problem, const AnchorJudgement& found);

/// A motion that the anchors that agree share against the keyframes, where it is the larger part of
/// their errors: it is followed, because their frames are often different. Where a shift cannot be
/// told from an error of the odometry (a run at the begin or the end; anchors on a line, which hold
/// the first keyframe): both. Else empty.
std::string datum_shift_text(const Problem& problem, const AnchorJudgement& found);

}  // namespace loopbench::methods::consensus
