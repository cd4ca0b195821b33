#include "harness/run/doctor_notes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/catalogue/external_methods.hpp"
#include "metrics/doctor/diagnose.hpp"
#include "metrics/doctor/graph_checks.hpp"

namespace loopbench::harness {
namespace {

constexpr double kSureFinding = 0.5;  // `loopbench doctor` itself prints all findings

bool aligns_scale(const metrics::NamedProtocol& protocol) {
  const metrics::Align align = protocol.rules.align;
  return align == metrics::Align::sim3 || align == metrics::Align::scale;
}

std::vector<metrics::InputFinding> sure_findings(
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
  const bool is_aligned = std::ranges::all_of(protocols, aligns_scale);
  std::erase_if(out, [&](metrics::InputFinding& finding) {
    if (finding.fault == metrics::Fault::time_offset && offset != 0.0) {
      // The option replaces the offset that is already applied.
      finding.value += offset;
      finding.fix = fmt::format("--offset {:.4f}", finding.value);
    }
    return finding.confidence < kSureFinding ||
           finding.fault == metrics::Fault::lever_arm ||  // the evaluation has a note of its own
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
  std::vector<std::string> out;
  for (const metrics::InputFinding& finding : sure_findings(pair, protocols)) {
    out.push_back(kDoctorPrefix + text(finding));
  }
  return out;
}

std::vector<std::string> doctor_notes(const Sequence& sequence, const Sweep& sweep) {
  std::vector<std::string> out;
  const Provenance& source = sequence.provenance;
  const Problem& problem = sequence.problem;
  if (source.inputs.empty() || !source.noise.empty() || problem.keyframes.empty()) return out;
  const auto add = [&](const std::vector<metrics::InputFinding>& findings) {
    for (metrics::InputFinding finding : findings) {
      if (finding.confidence < kSureFinding) continue;
      if (finding.fault == metrics::Fault::time_offset) {
        finding.fix = fmt::format("protocol: {{offset: {:.4f}}}", finding.value);
      } else if (finding.fault == metrics::Fault::scale) {
        finding.fix = "protocol: {align: sim3}";
      }
      out.push_back(kDoctorPrefix + text(finding));
    }
  };
  if (!sequence.reference.empty()) {
    const bool has_stamps = has_own_stamps(sequence.reference) && has_own_stamps(problem.keyframes);
    add(sure_findings(
        {sequence.reference, problem.keyframes, source.reference.string(), "", has_stamps},
        sweep.protocols));
  }
  add(metrics::check_closures(problem));
  return out;
}

std::vector<std::string> closure_notes(const Problem& problem) {
  std::vector<std::string> out;
  for (const metrics::InputFinding& finding : metrics::check_closures(problem)) {
    if (finding.confidence >= kSureFinding) out.push_back(kDoctorPrefix + text(finding));
  }
  return out;
}

std::string movement_note(const Problem& problem,
                          const Trajectory& corrected,
                          const methods::Report& report,
                          bool uses_closures) {
  if (!uses_closures) return "";
  for (const methods::Count& count : report.counts) {
    const bool is_accepted = count.name == "closures_kept" || count.name == "closures_consistent";
    if (is_accepted && count.value == 0.0) return "";
  }
  const auto found = metrics::check_movement(problem, corrected);
  return found ? kDoctorPrefix + text(*found) : "";
}

bool uses_closures(const MethodChoice& choice, const Catalogue& catalogue) {
  return std::ranges::any_of(choice.stages, [&](const Choice& stage) {
    if (stage.name == "raw" || is_oracle(catalogue, stage.name)) return false;
    if (is_program(stage)) return true;
    const methods::Kind kind = find_method(catalogue, stage.name).kind;
    return kind == methods::Kind::corrector || kind == methods::Kind::joint;
  });
}

void CellNotes::add(const std::string& method, const CellResult& result) {
  for (const std::string& note : result.report.notes) {
    if (!note.starts_with(kDoctorPrefix)) continue;
    const auto known =
        std::ranges::find(counts_, method, &std::pair<std::string, std::size_t>::first);
    if (known == counts_.end()) {
      counts_.emplace_back(method, 1);
      examples_.push_back(note);
    } else {
      ++known->second;
    }
  }
}

std::vector<std::string> CellNotes::lines() const {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    const std::size_t count = counts_[i].second;
    out.push_back(fmt::format("{}: {}{}",
                              counts_[i].first,
                              examples_[i],
                              count == 1 ? "" : fmt::format(" (and {} more cells)", count - 1)));
  }
  return out;
}

}  // namespace loopbench::harness
