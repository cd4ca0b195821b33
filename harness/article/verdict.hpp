/// Verdicts on statements of the article, with effect sizes.
#pragma once

#include <array>
#include <string>
#include <utility>

namespace loopbench::harness {

enum class Verdict {
  holds,
  other_size,
  tie,
  does_not_hold,
  contradicts_itself,
  misprint,
  cannot_be_judged
};
inline auto choices(Verdict) {
  return std::array{std::pair{"holds", Verdict::holds},
                    std::pair{"same sign, other size", Verdict::other_size},
                    std::pair{"tie", Verdict::tie},
                    std::pair{"does not hold", Verdict::does_not_hold},
                    std::pair{"contradicts itself", Verdict::contradicts_itself},
                    std::pair{"misprint or gap", Verdict::misprint},
                    std::pair{"cannot be judged", Verdict::cannot_be_judged}};
}

constexpr double kTiedChange = 0.01;  ///< relative differences below this are ties [-]
constexpr double kTiedFit = 0.05;     ///< the same for fits to few or overlapping windows [-]
constexpr double kComparable = 2.0;   ///< largest factor between effects of comparable size

/// Verdict on a printed relative change. `holds` requires the same sign and a size within a factor
/// of `kComparable`; a change of ours below `kTiedChange` is a tie, unless the printed one is as
/// small.
Verdict verdict_on_change(double printed, double ours);

/// Verdict on "this one has the smallest error": `holds` if every other error is larger by more
/// than `kTiedChange`, `tie` if the smallest is within `kTiedChange`, otherwise `does_not_hold`.
Verdict verdict_on_smallest(double error, double smallest_other);

/// "+3.4" with one decimal; a value that rounds to zero has no minus sign.
std::string signed_tenths(double value);

/// "+3.4 %", or "+34 %" from 10 % on.
std::string percent_change(double change);

}  // namespace loopbench::harness
