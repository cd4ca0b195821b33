#include "harness/calibrate/calibration_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "harness/provenance/version.hpp"

namespace loopbench::harness {
namespace {

/// Double-quoted YAML scalar.
std::string yaml_quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

std::string list(const std::vector<std::string>& names) {
  std::vector<std::string> out;
  for (const std::string& name : names) out.push_back(yaml_quoted(name));
  return fmt::format("[{}]", fmt::join(out, ", "));
}

std::string likelihood_text(const std::optional<double>& value) {
  return value ? fmt::format("{:.3f}", *value) : "none";
}

}  // namespace

std::string calibration_yaml(const Calibration& c) {
  std::vector<std::string> trained;
  for (const CalibrationResiduals& s : c.sequences) trained.push_back(s.label);
  std::string out = fmt::format(
      "# Written by loopbench {} calibrate {}. Use in a config:\n"
      "#   - {{method: motion_drift, calibration: THIS_FILE}}\n"
      "trained_on: {}\n"
      "# Results on the same references or noise are marked as oracle results.\n"
      "trained_on_sources: {}\nnot_trained_on: {}\nedges_as_one: {}\n",
      kVersion,
      c.config,
      list(trained),
      list(c.sources),
      list(c.not_trained_on),
      c.every);

  out +=
      "# Root mean square errors over groups of this many edges, and the powers of the group "
      "length\n"
      "# with which they grow from the row above: 0.5 is noise, 1 is drift.\n";
  for (std::size_t i = 0; i < c.group_errors.size(); ++i) {
    const Calibration::GroupErrors& s = c.group_errors[i];
    out += fmt::format("# {:4} edges {:.3g} m {:.3g} rad", s.edges, s.rms[0], s.rms[1]);
    if (i > 0) {
      const Calibration::GroupErrors& before = c.group_errors[i - 1];
      const double longer = std::log(double(s.edges) / double(before.edges));
      out += fmt::format("; powers {:.2f} {:.2f}",
                         std::log(s.rms[0] / before.rms[0]) / longer,
                         std::log(s.rms[1] / before.rms[1]) / longer);
    }
    out += "\n";
  }
  out += "# Correlations of the regressors; near 1, two of them cannot be separated.\n";
  for (std::size_t a = 1; a < methods::kRegressors.size(); ++a) {
    for (std::size_t b = a + 1; b < methods::kRegressors.size(); ++b) {
      const double r = correlation(methods::kRegressors[a], methods::kRegressors[b], c.sequences);
      out += fmt::format("#   {} {}: {}\n",
                         methods::name_of(methods::kRegressors[a]),
                         methods::name_of(methods::kRegressors[b]),
                         std::isfinite(r) ? fmt::format("{:.2f}", r) : "one is constant");
    }
  }
  out += "# Log likelihood per error of held-out sequences: translation, rotation.\n";
  for (const NestedModel& model : c.models) {
    out += fmt::format("#   {:22} {} {}\n",
                       model.method,
                       likelihood_text(model.held_out[0]),
                       likelihood_text(model.held_out[1]));
  }
  for (std::size_t r = 0; r < c.models.size(); ++r) {
    out += c.models[r].method + ":\n";
    const auto options = options_of(c.models[r]);
    for (std::size_t j = 0; j < options.size(); ++j) {
      const RateInterval& interval = c.intervals[r][j];
      out += fmt::format("  {}: {:.6g}  # 90 %: {:.2g} .. {:.2g}\n",
                         options[j].first,
                         options[j].second,
                         interval.low,
                         interval.high);
    }
  }
  return out;
}

}  // namespace loopbench::harness
