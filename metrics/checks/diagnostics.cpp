#include "metrics/checks/diagnostics.hpp"

#include <algorithm>
#include <cmath>

#include "metrics/trajectory/heading.hpp"
#include "metrics/trajectory/position_only.hpp"
#include "metrics/trajectory/tracking_gaps.hpp"

namespace loopbench::metrics {
namespace {

void diagnose_pairs(const Evaluation& evaluation, Diagnostics& out) {
  const Trajectory& reference = evaluation.reference;
  const Trajectory& estimate = evaluation.estimate;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    for (const Trajectory* poses : {&reference, &estimate}) {
      const double norm = (*poses)[i].world_from_body.rotation.norm();
      out.off_unit = std::max(out.off_unit, std::abs(norm - 1.0));
    }
    if (i == 0) continue;
    const double gap = reference[i].stamp - reference[i - 1].stamp;
    const double ours = estimate[i].stamp - estimate[i - 1].stamp;
    out.longest_pair_interval = std::max(out.longest_pair_interval, gap);
    out.repeated += gap == 0.0 || ours == 0.0;
    out.crossing += gap < 0.0 || ours < 0.0;
  }
}

void diagnose_gaps(const Trajectory& reference,
                   const Trajectory& estimate,
                   double offset,
                   const DiagnosticsOptions& o,
                   Diagnostics& out) {
  for (const TrackingGap& gap :
       gaps_while_moving(reference, stamps(estimate), offset, o.tracking_gap, o.rest_speed)) {
    const double duration = gap.end - gap.begin;
    ++out.tracking_gaps;
    out.tracking_gap_time += duration;
    out.longest_tracking_gap = std::max(out.longest_tracking_gap, duration);
  }
}

}  // namespace

Diagnostics diagnose(const Evaluation& evaluation, const DiagnosticsOptions& options) {
  Diagnostics out;
  out.matched = evaluation.coverage.pairs;
  out.possible = evaluation.coverage.possible;
  out.rank = evaluation.alignment.rank;
  out.condition = evaluation.alignment.condition;
  diagnose_pairs(evaluation, out);
  const std::vector<Chord> windows = chords(evaluation.reference, options.window);
  const auto at_rest = std::ranges::count_if(
      windows, [&](const Chord& chord) { return !chord.is_moving(options.rest_speed); });
  if (!windows.empty())
    out.at_rest = static_cast<double>(at_rest) / static_cast<double>(windows.size());
  out.position_only_reference = is_position_only(evaluation.reference);
  out.position_only_estimate = is_position_only(evaluation.estimate);
  const Context& context = evaluation.context;
  if (context.reference != nullptr && context.estimate != nullptr) {
    diagnose_gaps(*context.reference, *context.estimate, context.protocol.offset, options, out);
  }
  return out;
}

std::vector<Score> diagnostics(const Evaluation& evaluation, const DiagnosticsOptions& options) {
  const Diagnostics d = diagnose(evaluation, options);
  const auto count_score = [](const char* name, std::size_t count) {
    return single(name, "", "1", static_cast<double>(count));
  };
  return descriptions({count_score("matched", d.matched),
                       count_score("possible", d.possible),
                       single("longest_pair_interval", "", "s", d.longest_pair_interval),
                       count_score("repeated", d.repeated),
                       count_score("crossing", d.crossing),
                       single("off_unit", "", "1", d.off_unit),
                       single("alignment_rank", "", "1", d.rank),
                       single("alignment_condition", "", "1", d.condition),
                       single("at_rest", "", "%", 100.0 * d.at_rest),
                       count_score("position_only_reference", d.position_only_reference),
                       count_score("position_only_estimate", d.position_only_estimate),
                       count_score("tracking_gaps", d.tracking_gaps),
                       single("tracking_gap_time", "", "s", d.tracking_gap_time),
                       single("longest_tracking_gap", "", "s", d.longest_tracking_gap)});
}

}  // namespace loopbench::metrics
