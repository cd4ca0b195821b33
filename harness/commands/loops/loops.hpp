/// The command `loops`: what the loop closures of one file state about each other.
#pragma once

#include <string>

#include "harness/answers/report/draw.hpp"
#include "harness/sweep/model/loops.hpp"

namespace loopbench::harness {

/// Computes the ledger of a problem. Throws InputError with `estimate` if it does not apply.
LoopsResult loops(Problem problem, std::string estimate);

/// Runs pose_graph_pcm and pose_graph_gnc_tls, unless they decline or fail, for `rejected`.
void add_rejections(LoopsResult& result);

/// The verdict and a table of the closures, the most suspicious first, at most `rows`.
std::string text(const LoopsResult& result, std::size_t rows);

/// Object with keys verdict, sentence, places, better_places, ratio, covered and closures, the rows
/// of csv().
std::string json(const LoopsResult& result);

/// Map of the keyframes with the closures coloured by what the others state about them.
FigureData loops_figure(const LoopsResult& result);

}  // namespace loopbench::harness
