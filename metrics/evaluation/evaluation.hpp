/// An estimate laid beside its reference: paired, aligned, with what was lost on the way.
#pragma once

#include <algorithm>
#include <string>

#include "datasets/core/curve.hpp"
#include "metrics/alignment/alignment.hpp"
#include "metrics/evaluation/context.hpp"
#include "metrics/pairing/association.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench {

/// Pair counts that stand beside every number.
struct Coverage {
  std::size_t pairs = 0;     ///< pose pairs that were judged
  std::size_t possible = 0;  ///< estimate poses (keyframes) or reference stamps in the span (dense)
  /// First to last judged reference stamp, less the losses in between (pauses above 2 s and ten
  /// times the usual step while the reference went on), over the reference's duration, 0..1.
  double span = 0.0;
  /// Dense: time in tracking gaps (losses.hpp) that the curve bridges without a measurement [s]. It
  /// is judged only where the protocol's max_estimate_gap is 0.
  double bridged = 0.0;

  double share() const {
    return possible == 0 ? 0.0 : static_cast<double>(pairs) / static_cast<double>(possible);
  }

  /// The smaller of both shares, by which coverage is judged.
  double least() const { return std::min(share(), span); }
};

/// reference[i] and estimate[i] belong together and share reference[i].stamp as their time; the
/// estimate keeps its own stamps. With association `evo` a pose may serve twice, so stamps may
/// repeat; around bursts `tum` may pair across each other, and then the estimate's go back.
struct Evaluation {
  Trajectory reference;
  Trajectory estimate;  ///< already moved onto the reference by `alignment`, both then flattened
  Alignment alignment;
  Coverage coverage;
  Protocol protocol;
  double reference_length = 0.0;  ///< path of the whole reference, matched or not [m]
  /// The whole lists as given, before pairing and alignment, when the protocol's pairs are of
  /// whole files. Empty otherwise.
  Paired whole;
  Context context;  ///< empty from evaluate(): whoever holds the problem and the curve fills it
};

/// Pairs two pose lists, aligns, counts. Throws std::runtime_error when nothing matches, the
/// alignment is degenerate, or wants attitudes of a file that holds positions only. Complexity O((n
/// + m) log(n + m)) or better.
Evaluation evaluate(const Trajectory& reference,
                    const Trajectory& estimate,
                    const Protocol& protocol);

/// The same for a curve, at its keyframes or densely at the reference's times: there association
/// is not used, the curve is asked at every reference stamp (minus offset) inside its span, except
/// in tracking gaps longer than max_estimate_gap: between `tracked` stamps (empty: the keyframes')
/// while the reference moved. Such stamps count as possible, not as pairs.
Evaluation evaluate(const Trajectory& reference,
                    const Curve& estimate,
                    const std::vector<double>& keyframe_stamps,
                    Times times,
                    const Protocol& protocol,
                    const std::vector<double>& tracked = {});

/// Why numbers that use attitudes mean nothing here (position_only.hpp), or empty when they do.
/// O(n).
std::string why_no_attitude(const Evaluation& evaluation);

}  // namespace loopbench
