#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "harness/base/counted.hpp"
#include "harness/base/write_file.hpp"
#include "harness/eval/correct.hpp"

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

}  // namespace

std::string text(const Correction& c) {
  std::string out = fmt::format("{} corrected by {}: {} keyframes, {}, {}",
                                c.estimate,
                                c.method,
                                c.keyframes.size(),
                                counted(c.problem.odometry.size(), "odometry edge"),
                                counted(c.problem.closures.size(), "closure"));
  if (!c.problem.anchors.empty()) out += ", " + counted(c.problem.anchors.size(), "anchor");
  if (c.rejected) out += fmt::format(" ({} rejected)", *c.rejected);
  out += fmt::format(", {:.1f} ms\n\n", 1e3 * c.seconds);
  if (c.before && c.after) {
    out += fmt::format("{:<28}{:>14}{:>14}\n", "", "before", "after");
    for (std::size_t i = 0; i < c.before->size(); ++i) {
      const auto& [key, title, before] = (*c.before)[i];
      out += fmt::format(
          "{:<28}{}{}\n", title, residual_text(before), residual_text((*c.after)[i].value));
    }
  } else {
    out += "no residuals: an edge changes the scale\n";
  }
  std::string counts;
  for (const methods::Count& count : c.report.counts) {
    counts += fmt::format("{}{} {:.6g}", counts.empty() ? "" : ", ", count.name, count.value);
  }
  if (!counts.empty()) out += "counts: " + counts + "\n";
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
  const nlohmann::json out = {
      {"estimate", c.estimate},
      {"method", c.method},
      {"keyframes", c.keyframes.size()},
      {"odometry", c.problem.odometry.size()},
      {"closures", c.problem.closures.size()},
      {"anchors", c.problem.anchors.size()},
      {"rejected", c.rejected ? nlohmann::json(*c.rejected) : nlohmann::json(nullptr)},
      {"seconds", c.seconds},
      {"before", residuals_json(c.before)},
      {"after", residuals_json(c.after)},
      {"counts", counts},
      {"phases", phases},
      {"notes", c.report.notes},
      {"output", {{"file", c.out}, {"poses", c.output.size()}, {"outside", c.outside}}}};
  return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace loopbench::harness
