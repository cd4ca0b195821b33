/// The metric `command`: any program that evaluates paired, aligned poses.
///
/// Version 1 of its exchange. {evaluation} is a folder with
///   reference.txt, estimate.txt  lines `stamp x y z qx qy qz qw` [s, m]: line i of one is paired
///                                with line i of the other; the estimate is aligned
///   evaluation.json              {exchange: 1, pairs, possible, span, scale, reference_length,
///                                times, units}
/// and {result} the JSON file to write, metrics/programs.md lists its keys. With `serve`, the same
/// JSON is the text of a message with kind: metric and the arrays reference and estimate.
#pragma once

#include <vector>

#include "harness/sweep/catalogue/command.hpp"
#include "metrics/metric.hpp"

namespace loopbench::harness {

/// Its entry; programs run in the current folder.
metrics::MetricEntry command_metric();

/// With the role of a metric: a program that is also a method is another process.
CommandOptions as_metric(CommandOptions program);

/// Scores of a program. Throws as MetricEntry::score.
std::vector<metrics::Score> command_scores(const metrics::Evaluation& evaluation,
                                           const CommandOptions& program);

/// Scores in the text of a result; lists of values become statistics with `ddof`, and a list of
/// length `pairs` is kept as Score::per_pose. Throws std::runtime_error, and Undefined if the
/// program declined.
std::vector<metrics::Score> parse_scores(const std::string& json, int ddof, std::size_t pairs);

}  // namespace loopbench::harness
