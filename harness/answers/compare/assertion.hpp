/// Sentences about two methods that a comparison must show: "dual is at least 15 % below raw".
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/answers/compare/compare.hpp"

namespace loopbench::harness {

/// The comparison of the same score with another baseline.
using CompareWith = std::function<Comparison(const std::string& baseline)>;

/// "assertion not shown: TEXT: REASON" for each of the sentences that is not shown. The reason is
/// the measured difference with its interval and p.
///
/// The words compare values, also of scores of which higher values are better. "below" is
/// significantly lower, "not above" not significantly higher, "not shown to differ" neither. With a
/// percentage, the upper end of the interval of the typical ratio decides, too: it is at most
/// 1 - percent / 100 ("at least X % below") or 1 + percent / 100 ("at most X % above"). Nothing is
/// shown about methods without a common run, and no order of a method that covers less of the
/// reference than others. Throws InputError for another sentence, naming the accepted ones, for an
/// order of values with a target, and for a method that `printed` does not have.
std::vector<std::string> not_shown(const std::vector<std::string>& sentences,
                                   const Comparison& printed,
                                   const CompareWith& compare_with);

}  // namespace loopbench::harness
