/// The command `loops`: what the loop closures of one file state about each other.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "datasets/core/sequence.hpp"
#include "harness/answers/report/draw.hpp"
#include "harness/sweep/model/loops.hpp"
#include "methods/correctors/ledger/next_closures.hpp"

namespace loopbench::harness {

/// Computes the ledger of a problem. Throws InputError with `estimate` if it does not apply.
/// `progress`: called with the work that begins.
LoopsResult loops(Problem problem,
                  std::string estimate,
                  const std::function<void(const std::string&)>& progress = {});

/// Where one more closure would help most, in the solution with the closures that agree. Throws
/// InputError if the solver finds none.
methods::NextClosures next_closures(const LoopsResult& result);

/// "200 keyframes, 8 closures, 6 places"; without closures the anchors.
std::string counts_text(const LoopsResult& result);

/// The verdict and a table of the closures, the most suspicious first, at most `rows`, in 80
/// columns; then `next`. Sentences are lines without a limit. Without closures the verdict alone.
std::string text(const LoopsResult& result,
                 std::size_t rows,
                 const std::optional<methods::NextClosures>& next = {});

/// Object with keys verdict, helps, sentence, places, better_places, ratio, covered, steps [{from,
/// to, metres, degrees, inflation or null}], anchors (null, or {used, decided, factor, dropped
/// [{at, metres, log_odds}]}), closures, the rows of csv(), and next {deviation, closures [{from,
/// to, metres, deviation}]} if it is given.
std::string json(const LoopsResult& result, const std::optional<methods::NextClosures>& next = {});

/// Writes the graph with the closures that agree and with freed steps, whose information is lower;
/// comments name them and the closures and anchors that were dropped. Lines of priors are those of
/// the input, except those of dropped anchors.
/// Throws InputError if nothing is decided (about the anchors, without closures), or if there are
/// anchors of another file, and if the file cannot be written.
void write_repaired(const LoopsResult& result,
                    const Provenance& provenance,
                    const std::filesystem::path& file);

/// Map of `poses` of the keyframes with the closures coloured by what the others state about them,
/// the steps of the odometry that are wrong, and lines from the poses to the anchors.
FigureData loops_figure(const LoopsResult& result, const Trajectory& poses, bool with_anchors);

/// A page in one file: the verdict, maps of the keyframes as they are given and as `correct` moves
/// them, and tables of closures (the most suspicious first, at most 500), steps and dropped
/// anchors.
std::string loops_page(const LoopsResult& result);

}  // namespace loopbench::harness
