/// What the loop closures of one trajectory or pose graph state about each other.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "datasets/core/problem.hpp"
#include "harness/report/draw.hpp"
#include "methods/correctors/closure_ledger.hpp"

namespace loopbench::harness {

struct LoopsResult {
  std::string estimate;
  Problem problem;
  methods::ClosureLedger ledger;
  /// Robust methods that ran, and the closures that each rejects, as indices in the problem.
  std::map<std::string, std::vector<std::size_t>> rejected = {};
  bool is_kept = false;  ///< the closures are those that a robust method kept
};

/// The stamp without the digits below a nanosecond that arithmetic has left: 184.7, not
/// 184.70000000000002.
double shown_stamp(double stamp);

/// Computes the ledger of a problem. Throws InputError with `estimate` if it does not apply.
LoopsResult loops(Problem problem, std::string estimate);

/// Runs pose_graph_pcm and pose_graph_gnc_tls, unless they decline or fail, for `rejected`.
void add_rejections(LoopsResult& result);

/// "145 -> 1590": the keyframes of a closure, the earlier one first.
std::string closure_name(const LoopsResult& result, std::size_t closure);

/// One to three sentences: whether the correction probably helps, or which closure contradicts the
/// others (at fewer than three places only that something does), or why nothing can be stated and
/// what would change that.
std::string verdict_text(const LoopsResult& result);

/// The verdict and a table of the closures, the most suspicious first, at most `rows`.
std::string text(const LoopsResult& result, std::size_t rows);

/// One row per closure in the order of `suspects`, with a header; lengths in metres, angles in
/// degrees, `sd` in standard deviations, names of keyframes as in the file.
std::string csv(const LoopsResult& result);

/// Object with keys verdict, sentence, places, better_places, ratio, covered and closures, the rows
/// of csv().
std::string json(const LoopsResult& result);

/// Map of the keyframes with the closures coloured by what the others state about them.
FigureData loops_figure(const LoopsResult& result);

}  // namespace loopbench::harness
