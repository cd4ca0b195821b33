/// A metric is a pure function from a paired, aligned estimate to named error distributions.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "datasets/core/fields.hpp"
#include "metrics/better.hpp"
#include "metrics/evaluation/evaluation.hpp"
#include "metrics/numerics/statistics.hpp"

namespace loopbench::metrics {

struct Score {
  std::string relation;  ///< what is measured: "translation", "rotation", "tracking_gap", ...
  std::string axis;      ///< "x", "y", "z", "3d"; "all" over all lengths; "" without an axis
  std::string unit;      ///< "m", "deg", "s"; "1" for ratios and numbers
  Statistics statistics;
  std::string why_undefined = {};  ///< set if the score is undefined; it has no statistics then
  Better better = Better::lower;
  double target = 0.0;                ///< best value where `better` is target
  std::vector<double> per_pose = {};  ///< value at each pair, for figures; empty: none
};

/// Returns the score with the given direction instead of `lower`.
inline Score directed(Score score, Better better, double target = 0.0) {
  score.better = better;
  score.target = target;
  return score;
}

/// Returns the scores as descriptions: no value is better than another.
inline std::vector<Score> descriptions(std::vector<Score> scores) {
  for (Score& score : scores) score.better = Better::neither;
  return scores;
}

/// Score of a single value: count 1, std 0, every other statistic the (signed) value. Throws
/// std::runtime_error if it is not finite.
Score single(std::string relation, std::string axis, std::string unit, double value);

struct MetricEntry {
  std::string name;
  std::string summary;
  std::vector<OptionInfo> options;
  std::function<void(const Params&)> check;  ///< throws OptionError; computes nothing
  /// Throws OptionError if the options contradict the protocol; null: they fit any protocol.
  std::function<void(const Params&, const Protocol&)> check_protocol = {};
  /// Throws OptionError for invalid options, Undefined if the sequence does not define the metric,
  /// std::runtime_error if the estimate cannot be evaluated.
  std::function<std::vector<Score>(const Evaluation&, const Params&)> score;
  bool needs_reference = true;  ///< false: uses only the context and runs without a reference
};

/// Wraps `std::vector<Score> score(const Evaluation&, const Options&)` as an entry. If they exist,
/// `void check_combination(const Options&)` rejects inconsistent fields, and
/// `void check_protocol(const Options&, const Protocol&)` rejects options that contradict the
/// protocol.
template <class Options, class Function>
MetricEntry metric(std::string name, std::string summary, Function score) {
  MetricEntry out;
  out.name = std::move(name);
  out.summary = std::move(summary);
  out.options = describe(Options{});
  out.check = [](const Params& given) {
    const Options options = with(Options{}, given);
    if constexpr (requires { check_combination(options); }) check_combination(options);
  };
  if constexpr (requires(Options o, Protocol p) { check_protocol(o, p); }) {
    out.check_protocol = [](const Params& given, const Protocol& protocol) {
      check_protocol(with(Options{}, given), protocol);
    };
  }
  out.score = [score](const Evaluation& evaluation, const Params& given) {
    return score(evaluation, with(Options{}, given));
  };
  return out;
}

/// The same for `std::vector<Score> score(const Evaluation&)`, a metric without options.
template <class Function>
MetricEntry metric(std::string name, std::string summary, Function score) {
  return metric<NoOptions>(
      std::move(name), std::move(summary), [score](const Evaluation& evaluation, const NoOptions&) {
        return score(evaluation);
      });
}

/// The same for a metric that uses only the problem and the estimate.
template <class Options, class Function>
MetricEntry metric_without_reference(std::string name, std::string summary, Function score) {
  MetricEntry out = metric<Options>(std::move(name), std::move(summary), score);
  out.needs_reference = false;
  return out;
}

/// All built-in metrics.
std::vector<MetricEntry> metrics();

}  // namespace loopbench::metrics
