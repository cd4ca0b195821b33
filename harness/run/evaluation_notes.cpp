#include "harness/run/evaluation_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "datasets/core/polyline.hpp"
#include "metrics/checks/association_error.hpp"
#include "metrics/errors/ate.hpp"
#include "metrics/trajectory/tracking_gaps.hpp"

namespace loopbench::harness {
namespace {

/// Number of parameters estimated from all pairs; 0 for alignments that do not use all pairs.
int fitted_parameters(const metrics::Evaluation& evaluation) {
  const auto first = static_cast<std::size_t>(evaluation.protocol.align_first);
  if (first > 0 && first < evaluation.coverage.pairs) return 0;
  switch (evaluation.alignment.type) {
    case metrics::Align::se3:
      return 6;
    case metrics::Align::sim3:
      return 7;
    case metrics::Align::posyaw:
      return 4;
    case metrics::Align::scale:
    case metrics::Align::origin:
    case metrics::Align::posyaw_origin:
    case metrics::Align::none:
      break;
  }
  return 0;
}

std::string few_pairs(const metrics::Evaluation& evaluation) {
  constexpr double kMost = 0.1;  // parameters per coordinate; errors are then 5 % too small
  const std::size_t coordinates = 3 * evaluation.coverage.pairs;
  const int parameters = fitted_parameters(evaluation);
  const double share = parameters / static_cast<double>(coordinates);
  if (share <= kMost) return "";
  const double bias = share < 1.0 ? 1.0 - std::sqrt(1.0 - share) : 1.0;
  return fmt::format(
      "few pairs: {} pairs have {} coordinates, and alignment {} fits {} parameters to them, so "
      "the errors are about {:.0f} % too small",
      evaluation.coverage.pairs,
      coordinates,
      to_text(evaluation.alignment.type),
      parameters,
      100.0 * bias);
}

std::string stamp_differences(const Trajectory& reference, const metrics::Evaluation& evaluation) {
  constexpr double kNegligible = 0.2;  // of the ATE; independent errors then add 2 %
  constexpr double kRounding = 1e-6;   // [s]
  const auto found = metrics::association_error(reference, evaluation);
  if (!found) return "";
  const Trajectory* const estimate = evaluation.context.estimate;
  const bool is_sparse = estimate != nullptr && reference.size() < estimate->size();
  const double error = metrics::ate(evaluation, {}).front().statistics.rmse;
  if (found->largest_difference < kRounding || found->metres <= kNegligible * error) return "";
  return fmt::format(
      "association: the stamps of paired poses differ by up to {:.3g} s; at the reference's speed "
      "this is an error of {:.3g} m (rmse), with an ATE of {:.3g} m; use association {}",
      found->largest_difference,
      found->metres,
      error,
      is_sparse ? "interpolate_estimate" : "interpolate");
}

std::string bridged(const metrics::Evaluation& evaluation) {
  if (evaluation.coverage.bridged == 0.0) return "";
  const bool is_evaluated = evaluation.protocol.max_estimate_gap == 0.0;
  return fmt::format(
      "tracking gaps: {:.3g} s between keyframes are bridged without a measurement, "
      "and {} (max_estimate_gap)",
      evaluation.coverage.bridged,
      is_evaluated ? "evaluated nevertheless" : "not evaluated");
}

void note_once(std::vector<std::string>& list, const std::string& text) {
  if (!text.empty() && std::ranges::count(list, text) == 0) list.push_back(text);
}

}  // namespace

std::vector<std::string> evaluation_notes(const Trajectory& reference,
                                          const metrics::Evaluation& evaluation) {
  std::vector<std::string> out;
  note_once(out, stamp_differences(reference, evaluation));
  note_once(out, few_pairs(evaluation));
  note_once(out, bridged(evaluation));
  return out;
}

std::vector<std::string> evaluation_notes(const Sequence& sequence, const Sweep& sweep) {
  constexpr double kLowCoverage = 0.5;
  std::vector<std::string> out;
  const Problem& problem = sequence.problem;
  if (sequence.reference.empty() || problem.keyframes.empty()) return out;
  for (const metrics::NamedProtocol& protocol : sweep.protocols) {
    for (const metrics::Times times : sweep.times) {
      try {
        const metrics::Evaluation evaluation = metrics::evaluate(sequence.reference,
                                                                 Polyline(problem.keyframes),
                                                                 stamps(problem.keyframes),
                                                                 times,
                                                                 protocol.rules,
                                                                 metrics::tracked_stamps(problem));
        const metrics::Coverage& covered = evaluation.coverage;
        if (covered.least() < kLowCoverage) {
          note_once(
              out,
              fmt::format("low coverage: {} of {} poses over {:.1f} % of the reference's time",
                          covered.pairs,
                          covered.possible,
                          100.0 * covered.span));
        }
        for (const std::string& note : evaluation_notes(sequence.reference, evaluation)) {
          note_once(out, note);
        }
      } catch (const std::runtime_error&) {
        // No pairs or no unique alignment: every cell reports that itself.
      }
    }
  }
  return out;
}

}  // namespace loopbench::harness
