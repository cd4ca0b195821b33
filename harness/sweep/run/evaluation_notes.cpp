#include "harness/sweep/run/evaluation_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "datasets/core/polyline.hpp"
#include "harness/sweep/model/note_text.hpp"
#include "metrics/checks/association_error.hpp"
#include "metrics/doctor/diagnose.hpp"
#include "metrics/doctor/graph_checks.hpp"
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
      return evaluation.planar ? 3 : 6;
    case metrics::Align::sim3:
      return evaluation.planar ? 4 : 7;
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

std::optional<Note> few_pairs(const metrics::Evaluation& evaluation) {
  constexpr double kMost = 0.1;  // parameters per coordinate; errors are then 5 % too small
  const std::size_t coordinates = (evaluation.planar ? 2 : 3) * evaluation.coverage.pairs;
  const int parameters = fitted_parameters(evaluation);
  const double share = parameters / static_cast<double>(coordinates);
  if (share <= kMost) return std::nullopt;
  const double bias = share < 1.0 ? 1.0 - std::sqrt(1.0 - share) : 1.0;
  return Note{.kind = NoteKind::few_pairs,
              .severity = Severity::caution,
              .numbers = {{"bias", 100.0 * bias, "%"},
                          {"pairs", static_cast<double>(evaluation.coverage.pairs)},
                          {"coordinates", static_cast<double>(coordinates)},
                          {"parameters", static_cast<double>(parameters)}},
              .detail = to_text(evaluation.alignment.type)};
}

std::optional<Note> stamp_differences(const Trajectory& reference,
                                      const metrics::Evaluation& evaluation) {
  constexpr double kNegligible = 0.2;  // of the ATE; independent errors then add 2 %
  constexpr double kRounding = 1e-6;   // [s]
  const auto found = metrics::association_error(reference, evaluation);
  if (!found) return std::nullopt;
  const Trajectory* const estimate = evaluation.context.estimate;
  const bool is_sparse = estimate != nullptr && reference.size() < estimate->size();
  const double error = metrics::ate(evaluation, {}).front().statistics.rmse;
  if (found->largest_difference < kRounding || found->metres <= kNegligible * error) {
    return std::nullopt;
  }
  return Note{.kind = NoteKind::association,
              .severity = Severity::caution,
              .numbers = {{"error", found->metres, "m"},
                          {"largest difference", found->largest_difference, "s"},
                          {"ate", error, "m"}},
              .remedy = {"association", is_sparse ? "interpolate_estimate" : "interpolate"}};
}

std::optional<Note> bridged(const metrics::Evaluation& evaluation) {
  if (evaluation.coverage.bridged == 0.0) return std::nullopt;
  const bool is_evaluated = evaluation.protocol.max_estimate_gap == 0.0;
  return Note{.kind = NoteKind::tracking_gaps,
              .severity = Severity::caution,
              .numbers = {{"bridged", evaluation.coverage.bridged, "s"},
                          {"evaluated", is_evaluated ? 1.0 : 0.0}}};
}

void note_once(std::vector<Note>& list, const std::optional<Note>& note) {
  if (note && std::ranges::count(list, *note) == 0) list.push_back(*note);
}

/// The unit of the value of a finding.
std::string unit_of(metrics::Fault::Name fault) {
  return fault == metrics::Fault::time_offset ? "s" : "";
}

Remedy remedy_of(const metrics::InputFinding& finding) {
  const bool is_offset = finding.fault == metrics::Fault::time_offset;
  return is_offset ? Remedy{"--offset", fmt::format("{:.4f}", finding.value)} : Remedy{finding.fix};
}

/// Notes of findings with a confidence of at least 0.5; `loopbench doctor` itself prints all.
std::vector<Note> notes_of(const std::vector<metrics::InputFinding>& findings) {
  constexpr double kSure = 0.5;
  std::vector<Note> out;
  for (const metrics::InputFinding& finding : findings) {
    if (finding.confidence < kSure) continue;
    out.push_back({.kind = from_text<NoteKind>(std::string(finding.fault)).value(),
                   .severity = Severity::decisive,
                   .numbers = {{"value", finding.value, unit_of(finding.fault)},
                               {"confidence", finding.confidence}},
                   .remedy = remedy_of(finding),
                   .detail = finding.evidence});
    if (finding.has_frame_numbers) out.back().numbers.push_back({"frame numbers", 1.0});
  }
  return out;
}

/// What the protocols leave.
std::vector<metrics::InputFinding> findings_of(
    const ReadPair& pair, const std::vector<metrics::NamedProtocol>& protocols) {
  if (protocols.empty() || pair.reference.empty() || pair.estimate.empty()) return {};
  const double offset = protocols.front().rules.offset;
  Trajectory shifted;
  if (offset != 0.0) {
    shifted = pair.estimate;
    for (StampedPose& pose : shifted) pose.stamp += offset;
  }
  std::vector<metrics::InputFinding> out =
      metrics::diagnosis(pair.reference,
                         offset != 0.0 ? shifted : pair.estimate,
                         pair.reference_name,
                         pair.estimate_name,
                         pair.has_stamps)
          .findings;
  const bool is_aligned = std::ranges::all_of(protocols, [](const metrics::NamedProtocol& each) {
    const metrics::Align align = each.rules.align;
    return align == metrics::Align::sim3 || align == metrics::Align::scale;
  });
  std::erase_if(out, [&](metrics::InputFinding& finding) {
    if (finding.fault == metrics::Fault::time_offset) {
      // The option replaces the offset that is already applied.
      finding.value += offset;
    }
    // The evaluation has a note of its own, but none of antennas.
    const bool is_known =
        finding.fault == metrics::Fault::other_body && !lacks_rotations(pair.reference);
    return is_known || (finding.fault == metrics::Fault::scale && is_aligned);
  });
  return out;
}

/// Stamps that readers generate begin at zero.
bool has_own_stamps(const Trajectory& poses) { return poses.front().stamp != 0.0; }

}  // namespace

std::vector<Note> evaluation_notes(const Trajectory& reference,
                                   const metrics::Evaluation& evaluation) {
  std::vector<Note> out;
  note_once(out, stamp_differences(reference, evaluation));
  note_once(out, few_pairs(evaluation));
  note_once(out, bridged(evaluation));
  return out;
}

std::vector<Note> evaluation_notes(const Sequence& sequence, const Sweep& sweep) {
  constexpr double kLowCoverage = 0.5;
  std::vector<Note> out;
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
          note_once(out,
                    Note{.kind = NoteKind::low_coverage,
                         .severity = Severity::decisive,
                         .numbers = {{"span", 100.0 * covered.span, "%"},
                                     {"pairs", static_cast<double>(covered.pairs)},
                                     {"possible", static_cast<double>(covered.possible)}}});
        }
        for (const Note& note : evaluation_notes(sequence.reference, evaluation)) {
          note_once(out, note);
        }
      } catch (const std::runtime_error&) {
        // No pairs or no unique alignment: every cell reports that itself.
      }
    }
  }
  return out;
}

std::vector<Note> doctor_notes(const ReadPair& pair,
                               const std::vector<metrics::NamedProtocol>& protocols) {
  return notes_of(findings_of(pair, protocols));
}

std::vector<Note> doctor_notes(const Sequence& sequence, const Sweep& sweep) {
  const Provenance& source = sequence.provenance;
  const Problem& problem = sequence.problem;
  if (source.inputs.empty() || !source.noise.empty() || problem.keyframes.empty()) return {};
  std::vector<Note> out = notes_of(metrics::check_closures(problem));
  if (sequence.reference.empty()) return out;
  const bool has_stamps = has_own_stamps(sequence.reference) && has_own_stamps(problem.keyframes);
  const ReadPair pair{
      sequence.reference, problem.keyframes, source.reference.string(), "", has_stamps};
  for (Note& note : notes_of(findings_of(pair, sweep.protocols))) {
    if (note.kind == NoteKind::time_offset)
      note.remedy = {kConfigProtocol, "{offset: " + note.remedy.value + "}"};
    if (note.kind == NoteKind::scale) note.remedy = {kConfigProtocol, "{align: sim3}"};
    out.push_back(std::move(note));
  }
  return out;
}

std::vector<Note> closure_notes(const Problem& problem, const methods::ClosureJudgement* known) {
  return notes_of(metrics::check_closures(problem, known));
}

}  // namespace loopbench::harness
