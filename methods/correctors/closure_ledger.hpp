/// What the loop closures of a chain state about each other: how well each is predicted by the
/// closures of other places, without a reference.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench::methods {

/// Error of a closure against a prediction of its relative pose.
struct ClosureError {
  double metres = 0.0;
  double degrees = 0.0;
  /// Squared Mahalanobis distance per degree of freedom (3 if the problem is planar, else 6) [-].
  /// The covariance is that of the prediction and of the closure.
  double chi2 = 0.0;
};

struct LedgerRow {
  std::size_t place = 0;                  ///< of the closure, in the order of closures
  double loop_length = 0.0;               ///< distance travelled between its keyframes [m]
  ClosureError in_odometry;               ///< against the odometry alone
  std::optional<ClosureError> predicted;  ///< by the closures of all other places; unset: none
  double cost_drop = 0.0;    ///< decrease of chi2 of the joint solution without the closure [-]
  double moves_rms = 0.0;    ///< change of the keyframes' positions without the closure [m]
  double moves_max = 0.0;    ///< largest such change [m]
  std::size_t moves_at = 0;  ///< keyframe of the largest change
};

inline constexpr std::size_t kMinPlaces = 3;  ///< two cannot show which of them is wrong

enum class LedgerVerdict {
  helps,           ///< the correction probably reduces the error
  not_shown,       ///< predictions are not better than the odometry
  few_places,      ///< fewer than three places
  little_covered,  ///< most of the path lies in loops of fewer than two places
  contradiction,   ///< a closure contradicts the others
  covariances,     ///< closures contradict, and most of them the odometry: covariances too small
};

/// Whether closures contradict each other.
inline bool is_contradicted(LedgerVerdict verdict) {
  return verdict == LedgerVerdict::contradiction || verdict == LedgerVerdict::covariances;
}

struct ClosureLedger {
  std::vector<LedgerRow> rows;        ///< one per closure of the problem
  std::vector<std::size_t> suspects;  ///< all closures, the most suspicious first
  std::size_t places = 0;
  std::size_t better_places = 0;  ///< whose prediction has a smaller error than the odometry
  double ratio = 1.0;    ///< geometric mean over places of predicted over odometry's error [-]
  double covered = 0.0;  ///< share of the path inside loops of two or more places [-]
  /// Median over closures of `in_odometry.chi2`. False closures do not change that of others, so it
  /// stays near 1 while most closures are true and the covariances are right.
  double odometry_chi2 = 0.0;
  LedgerVerdict verdict = LedgerVerdict::few_places;
};

/// Returns why closure_ledger() does not apply, or an empty text: anchors, edges that change the
/// scale, an odometry that is no complete chain, no closures or more than 1,000.
std::string why_no_ledger(const Problem& problem);

/// Computes the ledger from one joint solution (looped_chain.hpp). With M = A S A' + S_L and
/// multipliers lambda at the solution, the closures of a place p have the error
/// ((M^-1)_pp)^-1 lambda_p against a solution without them, with covariance ((M^-1)_pp)^-1. This is
/// exact for linear loops. Two closures belong to one place if both their ends are within 20
/// keyframes along the path, directly or through others (single linkage).
///
/// Limits of the verdicts were chosen on KITTI, MulRan, wheel and flight data, see
/// results/methods/loops.md. Errors that all closures share are not visible. Requires
/// why_no_ledger() to be empty. Throws std::runtime_error if the joint solution fails.
/// O(closures keyframes + (6 closures)^3) time, O((6 closures)^2) memory.
ClosureLedger closure_ledger(const Problem& problem);

}  // namespace loopbench::methods
