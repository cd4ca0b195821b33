/// The best of several methods.
///
/// A method is significantly better than another if their pair's p, corrected for the number of
/// other methods, is at most alpha: that covers each method against the baseline, or each against
/// the leader. Equal methods count once. The leader was run on half of the groups or more
/// and is ahead of all others by ranks, if there is such a method, and best if it is significantly
/// better than all of them; methods behind it by less than a relevant difference are best with it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/compare/pair.hpp"
#include "harness/compare/ranks.hpp"

namespace loopbench::harness {

/// Unit of observation.
enum class Over {
  groups,    ///< runs with the same CellRow::group, or single runs without a group
  sequences  ///< all runs of a sequence or of a group: generalises to other sequences
};

struct CompareOptions {
  std::string baseline;
  std::string value = "rmse";
  Over over = Over::groups;
  double alpha = 0.05;     ///< probability of a false claim among those about a score
  double tie = kTieShare;  ///< relative difference up to which values are equal
  double relevant = 0.01;  ///< relative difference from which on a method is better for practice
  bool paired = false;     ///< also pair runs of files, by their names; those of sweeps always are
};

/// How a method compares with the leader.
enum class Standing {
  leader,
  equal,   ///< on every run
  near,    ///< significantly worse, but typically by less than a relevant difference
  behind,  ///< significantly worse
  open     ///< not significantly different
};

struct Ranking {
  std::size_t leader = 0;
  std::vector<Standing> standings;  ///< of each method
  std::vector<Pair> from_leader;    ///< the leader against each method
  std::size_t tests = 1;            ///< different methods, but one
  bool can_show = false;            ///< whether p of some pair can be small enough
  /// Fewest groups for which it can be; of independent runs, fewest of each method and sequence.
  std::size_t groups_needed = 1;

  bool is_leading(std::size_t method) const { return standings[method] < Standing::behind; }
  /// Whether the leading methods are significantly better than all others; false if all are equal.
  bool is_best() const;
};

/// Deterministic. O(methods * (runs log runs + groups^3)), groups^3 for up to 50 groups only.
Ranking rank_methods(const Levels& levels, const CompareOptions& options);

}  // namespace loopbench::harness
