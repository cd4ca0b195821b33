/// What the loop closures of one trajectory or pose graph state about each other, in words.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/correctors/closure_ledger.hpp"

namespace loopbench::harness {

struct LoopsResult {
  std::string estimate;
  Problem problem;
  methods::ClosureLedger ledger;
};

/// The stamp without the digits below a nanosecond that arithmetic has left: 184.7, not
/// 184.70000000000002.
double shown_stamp(double stamp);

/// "145 -> 1590": the keyframes of a closure, the earlier one first.
std::string closure_name(const Problem& problem, std::size_t closure);

/// For people: three digits or more and no exponent, at most three decimals: 2467, 12.4, 0.031.
std::string plain_number(double value);

/// Whether closures or anchors contradict each other or the odometry.
bool is_contradicted(const LoopsResult& result);

/// Whether the closures agree, or which contradict the others (in which order), or why nothing can
/// be stated and what would change that; whether the correction probably helps; which anchors are
/// dropped.
std::string verdict_text(const LoopsResult& result);

/// Of the closure at a rank of `suspects`: "agrees", "disagrees", or "unchecked".
const char* judgement(const LoopsResult& result, std::size_t rank);

/// "12 -> 13": the keyframes of a step of the odometry.
std::string step_name(const Problem& problem, std::size_t from);

/// The stamp of a keyframe without a name [s], of which every digit counts.
struct LedgerStamp {
  double stamp = 0.0;
};

/// A name, a number, or nothing: there is none, or it was not computed.
using LedgerValue = std::variant<std::monostate, std::string, std::int64_t, LedgerStamp, double>;

/// Names and values of the columns for the closure at a rank of `suspects`: lengths in metres,
/// angles in degrees, `sd` in stated standard deviations, names of keyframes as in the file,
/// `closure` the index in the problem; `others_solved` and `without_solved`: 1 if the numbers are
/// those of a solution, 0 if they are linearised. Numbers are finite.
std::vector<std::pair<std::string, LedgerValue>> ledger_row(const LoopsResult& result,
                                                            std::size_t rank);

/// One line per closure in the order of `suspects`, with a header. Numbers have `digits` digits; 0:
/// all.
std::string csv(const LoopsResult& result, int digits = 0);

/// For the report of a sweep: the sentence, then the lines of csv(); only the reason if there is no
/// ledger, or it would take too long; empty without closures.
std::string stored_ledger(const Problem& problem);

}  // namespace loopbench::harness
