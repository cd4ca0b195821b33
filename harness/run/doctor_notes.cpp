#include "harness/run/doctor_notes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "metrics/doctor/diagnose.hpp"
#include "metrics/doctor/graph_checks.hpp"

namespace loopbench::harness {
namespace {

/// Notes of findings with a confidence of at least 0.5; `loopbench doctor` itself prints all.
std::vector<std::string> notes_of(const std::vector<metrics::InputFinding>& findings) {
  constexpr double kSure = 0.5;
  std::vector<std::string> out;
  for (const metrics::InputFinding& finding : findings) {
    if (finding.confidence >= kSure) out.push_back("doctor: " + text(finding));
  }
  return out;
}

/// What the protocols leave.
std::vector<metrics::InputFinding> findings_of(
    const ReadPair& pair, const std::vector<metrics::NamedProtocol>& protocols) {
  if (protocols.empty() || pair.reference.empty() || pair.estimate.empty()) return {};
  const double offset = protocols.front().rules.offset;
  Trajectory shifted = pair.estimate;
  for (StampedPose& pose : shifted) pose.stamp += offset;
  std::vector<metrics::InputFinding> out =
      metrics::diagnosis(
          pair.reference, shifted, pair.reference_name, pair.estimate_name, pair.has_stamps)
          .findings;
  const bool is_aligned = std::ranges::all_of(protocols, [](const metrics::NamedProtocol& each) {
    const metrics::Align align = each.rules.align;
    return align == metrics::Align::sim3 || align == metrics::Align::scale;
  });
  std::erase_if(out, [&](metrics::InputFinding& finding) {
    if (finding.fault == metrics::Fault::time_offset) {
      // The option replaces the offset that is already applied.
      finding.value += offset;
      finding.fix = fmt::format("--offset {:.4f}", finding.value);
    }
    return finding.fault == metrics::Fault::lever_arm ||  // the evaluation has a note of its own
           finding.fault == metrics::Fault::body_rotation ||
           (finding.fault == metrics::Fault::scale && is_aligned);
  });
  return out;
}

/// Stamps that readers generate begin at zero.
bool has_own_stamps(const Trajectory& poses) { return poses.front().stamp != 0.0; }

}  // namespace

std::vector<std::string> doctor_notes(const ReadPair& pair,
                                      const std::vector<metrics::NamedProtocol>& protocols) {
  return notes_of(findings_of(pair, protocols));
}

std::vector<std::string> doctor_notes(const Sequence& sequence, const Sweep& sweep) {
  const Provenance& source = sequence.provenance;
  const Problem& problem = sequence.problem;
  if (source.inputs.empty() || !source.noise.empty() || problem.keyframes.empty()) return {};
  std::vector<metrics::InputFinding> found = metrics::check_closures(problem);
  if (!sequence.reference.empty()) {
    const bool has_stamps = has_own_stamps(sequence.reference) && has_own_stamps(problem.keyframes);
    const ReadPair pair{
        sequence.reference, problem.keyframes, source.reference.string(), "", has_stamps};
    for (metrics::InputFinding& finding : findings_of(pair, sweep.protocols)) {
      if (finding.fault == metrics::Fault::time_offset) {
        finding.fix = fmt::format("protocol: {{offset: {:.4f}}}", finding.value);
      } else if (finding.fault == metrics::Fault::scale) {
        finding.fix = "protocol: {align: sim3}";
      }
      found.push_back(std::move(finding));
    }
  }
  return notes_of(found);
}

std::vector<std::string> closure_notes(const Problem& problem) {
  return notes_of(metrics::check_closures(problem));
}

}  // namespace loopbench::harness
