/// Answers a claim from a comparison, with correction for repeated looks.
#pragma once

#include <string>

#include "harness/compare/compare.hpp"
#include "harness/model/claim.hpp"

namespace loopbench::harness {

/// Level of the k-th look (from 1): two thirds of alpha for the first, alpha / (3 k (k - 1)) for
/// the others, whose sum is alpha however often one looks. At 0.05 seven equal signs can decide at
/// the first look, ten at the second.
double level_of_look(double alpha, std::size_t k);

/// What the interval and the geometric mean ratio of a look say about the claim, whose margin may
/// have been edited since.
ClaimAnswer answer_of(const Claim& claim, const Look& look);

/// The answer of one look at `level`. The interval of the typical ratio decides: *holds* if it lies
/// below 1 - margin, *does not hold* if it lies above, otherwise *cannot tell*, as with too few
/// groups or a geometric mean ratio on the other side. `comparison` was made at that level with the
/// claim's baseline. Throws InputError if a method is missing, with the reason.
Look look_at(const Claim& claim, const Comparison& comparison, double level);

/// Whether two looks saw the same results, to six digits: the second one tells nothing new.
bool has_same_results(const Look& a, const Look& b);

/// "dual is 23.1 % below raw [18.0, 29.9] (interval of 96.7 %), 12 groups better, 4 worse; claimed:
/// at least 5 % below".
std::string text_of(const Claim& claim, const Look& look);

}  // namespace loopbench::harness
