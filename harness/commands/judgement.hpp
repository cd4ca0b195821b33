/// Two trajectory files laid side by side, without a sweep: what `eval` computes and shows.
#pragma once

#include <string>
#include <vector>

#include "metrics/metric.hpp"

namespace loopbench {

struct JudgedMetric {
  std::string name;
  Params options;  ///< those that differ from the defaults of the metric
  std::vector<Score> scores;
  std::string why_undefined;  ///< set instead of scores
};

struct Judgement {
  std::string reference;
  std::string estimate;
  std::size_t reference_poses = 0;
  std::size_t estimate_poses = 0;
  Protocol protocol;
  Coverage coverage;
  Alignment alignment;
  std::vector<Score> diagnosis;  ///< of `diagnostics` at its defaults
  std::vector<JudgedMetric> metrics;
};

/// ate and axis_error at their defaults, rpe over 1 frame, 1 s and 1 m. A metric that
/// is undefined here says why; throws std::runtime_error only when nothing can be judged.
Judgement judge(const Trajectory& reference, const Trajectory& estimate, const Protocol& protocol);

/// A table for people, numbers with six decimals.
std::string text(const Judgement& judgement);

/// One object for one judgement, an array for several; doubles in full precision. Keys: reference,
/// estimate, protocol, pairs, possible, coverage (pairs / possible), span, alignment {type, scale,
/// rank, condition}, diagnosis {name: value}, metrics [{metric, options, relation, axis, unit,
/// rmse, mean, median, std, min, max, count}], undefined [{metric, options, why}], with relation
/// and axis when only one number of a metric is.
std::string json(const std::vector<Judgement>& judgements);

}  // namespace loopbench
