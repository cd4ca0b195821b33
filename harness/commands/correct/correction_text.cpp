#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "harness/commands/correct/correct.hpp"
#include "harness/commands/loops/loop_json.hpp"
#include "harness/commands/loops/loops.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/text/counted.hpp"

namespace loopbench::harness {
namespace {

/// Five digits; rounding errors are 0.
std::string residual_text(double value) {
  constexpr double kRounding = 1e-12;
  return fmt::format("{:>14.5g}", std::abs(value) < kRounding ? 0.0 : value);
}

nlohmann::json residuals_json(const std::optional<std::vector<Residual>>& residuals) {
  if (!residuals) return nullptr;
  nlohmann::json out;
  for (const Residual& each : *residuals) out[each.key] = each.value;
  return out;
}

/// The rejected closures by ids or stamps, at most twenty of them.
std::string rejected_text(const Correction& c) {
  constexpr std::size_t kMost = 20;
  if (!c.report.rejected || c.report.rejected->empty()) return "";
  if (c.is_consensus && !c.check->is_decided()) return "";  // nothing is moved
  const std::vector<std::size_t>& all = *c.report.rejected;
  std::string out = "rejected:";
  for (std::size_t i = 0; i < std::min(all.size(), kMost); ++i) {
    const Edge& edge = c.problem.closures[all[i]];
    out += fmt::format(
        "{} {} -> {}", i == 0 ? "" : ",", c.problem.name_of(edge.from), c.problem.name_of(edge.to));
  }
  if (all.size() > kMost) out += fmt::format(" and {} more (--json lists all)", all.size() - kMost);
  return out + "\n\n";
}

nlohmann::json rejected_json(const Correction& c) {
  if (!c.report.rejected) return nullptr;
  nlohmann::json out = nlohmann::json::array();
  for (const std::size_t k : *c.report.rejected) {
    const Edge& edge = c.problem.closures[k];
    out.push_back(
        {{"from", keyframe_json(c.problem, edge.from)}, {"to", keyframe_json(c.problem, edge.to)}});
  }
  return out;
}

}  // namespace

CheckSentence check_sentence(const Correction& c) {
  if (!c.check) return {};
  return sentence(*c.check,
                  c.problem,
                  {.method = c.method,
                   .is_consensus = c.is_consensus,
                   .rejected = c.report.rejected.value_or(std::vector<std::size_t>{})});
}

std::string text(const Correction& c) {
  const CheckSentence check = check_sentence(c);
  std::string out = check.is_warning ? "Warning: " + check.text + "\n\n" : "";
  out += fmt::format("{} corrected by {}: {} keyframes, {}, {}",
                     c.estimate,
                     c.method,
                     c.keyframes.size(),
                     counted(c.problem.odometry.size(), "odometry edge"),
                     counted(c.problem.closures.size(), "closure"));
  if (c.is_consensus && c.check->judgement != nullptr && !c.check->is_decided()) {
    out += " (not used: undecided)";
  } else if (c.rejected) {
    out += fmt::format(" ({} rejected)", *c.rejected);
  }
  if (!c.problem.anchors.empty()) out += ", " + counted(c.problem.anchors.size(), "anchor");
  out += fmt::format(", {:.1f} ms\n\n", 1e3 * c.seconds);
  out += rejected_text(c);
  if (c.before && c.after) {
    const std::size_t rejected = c.report.rejected ? c.report.rejected->size() : 0;
    const bool has_rejected = rejected > 0 && rejected < c.problem.closures.size();
    const char* const which = has_rejected ? "without rejected closures" : "";
    out += fmt::format("{:<28}{:>14}{:>14}\n", which, "before", "after");
    for (std::size_t i = 0; i < c.before->size(); ++i) {
      const auto& [key, title, before] = (*c.before)[i];
      out += fmt::format(
          "{:<28}{}{}\n", title, residual_text(before), residual_text((*c.after)[i].value));
    }
  } else {
    out += "no residuals: " + c.why_no_residuals + "\n";
  }
  if (!check.text.empty() && !check.is_warning) out += "closures: " + check.text + "\n";
  for (const std::string& note : c.report.notes) out += "note: " + note + "\n";
  if (!c.out.empty() && !is_dash(c.out)) {
    out += fmt::format("\n{} in {}\n", counted(c.output.size(), "pose"), c.out);
  }
  if (c.outside > 0) {
    out += counted(c.outside, "skipped stamp") + " outside the time span of the keyframes\n";
  }
  return out;
}

std::string json(const Correction& c) {
  nlohmann::json counts = nlohmann::json::object();
  for (const methods::Count& count : c.report.counts) counts[count.name] = count.value;
  nlohmann::json phases = nlohmann::json::array();
  for (const methods::Phase& phase : c.report.phases) {
    phases.push_back({{"name", phase.name}, {"seconds", phase.seconds}});
  }
  const std::string verdict = check_sentence(c).text;
  const nlohmann::json out = {
      {"estimate", c.estimate},
      {"method", c.method},
      {"keyframes", c.keyframes.size()},
      {"odometry", c.problem.odometry.size()},
      {"closures", c.problem.closures.size()},
      {"anchors", c.problem.anchors.size()},
      {"rejected", c.rejected ? nlohmann::json(*c.rejected) : nlohmann::json(nullptr)},
      {"rejected_closures", rejected_json(c)},
      {"seconds", c.seconds},
      {"before", residuals_json(c.before)},
      {"after", residuals_json(c.after)},
      {"counts", counts},
      {"phases", phases},
      {"notes", c.report.notes},
      {"verdict", verdict.empty() ? nlohmann::json(nullptr) : nlohmann::json(verdict)},
      {"closure_check", c.check ? json(*c.check, c.problem) : nlohmann::json(nullptr)},
      {"output", {{"file", c.out}, {"poses", c.output.size()}, {"outside", c.outside}}}};
  return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace loopbench::harness
