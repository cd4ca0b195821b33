/// Pairing and alignment of an estimate with its reference, with coverage.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "datasets/core/curve.hpp"
#include "datasets/core/error.hpp"
#include "datasets/core/pose.hpp"
#include "datasets/core/sequence.hpp"
#include "metrics/alignment/alignment.hpp"
#include "metrics/pairing/association.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench::metrics {

/// Thrown by a metric if the sequence, not the method, makes it undefined: no closures, no curve, a
/// reference that does not move. Recorded as a `declined` row with this reason, not as a failure.
/// Reasons do not name the metric: whatever prints them does.
class Undefined final : public Declined {
 public:
  using Declined::Declined;
};

/// Poses of both files with the digits as printed, in file order; set if both files hold matrices.
struct PrintedPoses {
  std::vector<PoseMatrix> reference;
  std::vector<PoseMatrix> estimate;
};

/// Runs the method again on its problem without these closures (indices, ascending), and returns
/// the poses at its keyframes. Throws what the method throws, and Undefined if it declines.
using SolveWithout = std::function<Trajectory(const std::vector<std::size_t>& closures)>;

/// Non-owning pointers, null where the data do not exist: two files have neither problem nor curve.
struct Context {
  const Trajectory* reference = nullptr;  ///< complete, before pairing
  const Trajectory* estimate = nullptr;   ///< complete, before pairing and alignment; for a curve
                                          ///< its poses at the keyframes
  const Problem* problem = nullptr;       ///< input of the method
  const Curve* curve = nullptr;           ///< continuous-time estimate, before alignment
  Times times = Times::keyframes;         ///< evaluation times of the pairs
  Protocol protocol;
  const PrintedPoses* printed =
      nullptr;  ///< the printed matrices behind `reference` and `estimate`
  /// Candidates of the place recognition, accepted or not; empty without place recognition.
  const std::vector<LoopCandidate>* loop_candidates = nullptr;
  /// Of each pose of `reference` and `estimate` (datasets/core/covariance.hpp).
  const std::vector<Matrix6>* reference_covariances = nullptr;
  const std::vector<Matrix6>* estimate_covariances = nullptr;
  const SolveWithout* solve_without = nullptr;
  /// Indices in `problem->closures`, ascending: the false ones (null: unknown), and those that the
  /// method rejected (null: it does not choose among them).
  const std::vector<std::size_t>* false_closures = nullptr;
  const std::vector<std::size_t>* rejected_closures = nullptr;
};

/// Dereferences the view. Throws Undefined "needs WHAT, which files do not have" if null.
template <class View>
const View& needed(const View* view, const std::string& what) {
  if (view == nullptr) throw Undefined("needs " + what + ", which files do not have");
  return *view;
}

/// The same; sources of version 1.0 named the metric.
template <class View>
const View& needed(const View* view, const std::string& /*metric*/, const std::string& what) {
  return needed(view, what);
}

/// Pair counts that are reported with every score.
struct Coverage {
  std::size_t pairs = 0;     ///< evaluated pose pairs
  std::size_t possible = 0;  ///< estimate poses (keyframes; interpolate_estimate: all reference
                             ///< poses) or reference stamps in the span (dense)
  /// Time that the evaluated reference stamps cover, over the reference's duration, 0..1: from the
  /// first to the last, without pauses while the reference moved: tracking gaps (above 2 s and ten
  /// times the median interval) entirely, others but for 5 s.
  double span = 0.0;
  /// Dense: duration of the tracking gaps (tracking_gaps.hpp) that the curve bridges without a
  /// measurement [s]. Evaluated only if the protocol's max_estimate_gap is 0.
  double bridged = 0.0;

  double share() const {
    return possible == 0 ? 0.0 : static_cast<double>(pairs) / static_cast<double>(possible);
  }

  /// The smaller of share and span, which the coverage checks use.
  double least() const { return std::min(share(), span); }
};

/// reference[i] and estimate[i] are paired, and reference[i].stamp is their time; the estimate
/// keeps its own stamps. With association `evo` a pose can be used twice, so stamps can repeat.
/// With `tum` pairs can cross around bursts, so the estimate's stamps can decrease.
struct Evaluation {
  Trajectory reference;
  Trajectory estimate;  ///< after alignment; both lists are projected by the protocol
  Alignment alignment;
  bool planar = false;  ///< both move in a plane, and are aligned in x, y and yaw
  Coverage coverage;
  Protocol protocol;
  double reference_length = 0.0;  ///< path length of the complete reference [m]
  /// The complete lists before pairing and alignment, if the protocol's pair rule needs complete
  /// files. Empty otherwise.
  Paired complete;
  Context context;  ///< evaluate() leaves it empty; the caller that has problem and curve fills it
};

/// Pairs two pose lists, aligns them and counts the pairs. Throws std::runtime_error if nothing
/// matches, the alignment is degenerate, or the alignment needs orientations and a file holds only
/// positions. O((n + m) log(n + m)) or better.
Evaluation evaluate(const Trajectory& reference,
                    const Trajectory& estimate,
                    const Protocol& protocol = {});

/// The same for a curve, evaluated at its keyframes or densely at the reference's stamps. Dense
/// evaluation does not use the association: the curve is evaluated at every reference stamp (minus
/// offset) inside its span, except in tracking gaps longer than max_estimate_gap: pauses between
/// `tracked` stamps (if empty, the keyframe stamps) while the reference moved. The skipped stamps
/// count as possible, not as pairs.
Evaluation evaluate(const Trajectory& reference,
                    const Curve& estimate,
                    const std::vector<double>& keyframe_stamps,
                    Times times,
                    const Protocol& protocol,
                    const std::vector<double>& tracked = {});

/// Why scores that use orientations are undefined (position_only.hpp); empty if they are defined.
/// O(n).
std::string why_no_attitude(const Evaluation& evaluation);

}  // namespace loopbench::metrics
