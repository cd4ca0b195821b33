/// Scores of one evaluation: the metrics of a sweep, of cells and of files alike.
#pragma once

#include <string>

#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/model/result.hpp"
#include "harness/sweep/model/sweep.hpp"
#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::harness {

/// Adds all scores of one metric, or one row with the reason why there are none: exceptions of the
/// metric are not thrown. `row` has protocol, times, status and why of the rows. The metric of a
/// plugin gets a copy of its input.
void add_scores_of(CellResult& result,
                   const MetricChoice& choice,
                   const ScoreResult& row,
                   const metrics::Evaluation& evaluation,
                   const Sweep& sweep,
                   const Catalogue& catalogue);

/// Adds the scores of all metrics of the sweep to `result`. If the coverage is below the limit of
/// the sweep, these rows and the result are incomplete. `parallel`: several metrics at a time.
void add_scores(CellResult& result,
                ScoreResult row,
                const metrics::Evaluation& evaluation,
                const Sweep& sweep,
                const Catalogue& catalogue,
                bool parallel = false);

/// Adds the row `failure` for every metric of the sweep: there was nothing to evaluate.
void add_failure(CellResult& result, ScoreResult failure, const Sweep& sweep);

/// Reason why the coverage (pairs or time) is below `min_coverage` (0..1); empty if it is not.
std::string incomplete_reason(const metrics::Coverage& coverage, double min_coverage);

}  // namespace loopbench::harness
