#include <fmt/format.h>

#include <cmath>

#include "harness/compare/power.hpp"
#include "harness/tables/comparison.hpp"

namespace loopbench::harness {
namespace {

std::string gain_text(double effect, double deviation) {
  const double gain = -std::expm1(-effect * deviation);
  return std::isfinite(effect) ? fmt::format("{:.1f} %", 100.0 * gain) : "none";
}

std::string groups_text(std::size_t groups) {
  return groups < Power::kMostGroups ? fmt::format("{}", groups)
                                     : fmt::format(">= {}", Power::kMostGroups);
}

}  // namespace

Table power_table(const Comparison& c, double gain) {
  const std::string unit = c.has_strata ? "runs per sequence" : "groups";
  Table out{title(c) + ": power against " + c.options.baseline,
            {"method",
             unit,
             "deviation",
             "found with 80 %",
             fmt::format("{} for {:g} %", unit, 100.0 * gain)},
            {},
            {}};
  if (c.methods.empty()) {
    out.notes.push_back(statement(c));
    return out;
  }
  Power power(level_of_one(c.options.alpha, c.tests), c.has_strata ? c.sequences : 0);
  for (const MethodVerdict& m : c.methods) {
    if (m.method == c.options.baseline) continue;
    std::size_t groups = m.wins + m.losses + m.ties;
    if (c.has_strata) {  // pairs of runs
      const auto pairs = static_cast<double>(groups) / static_cast<double>(c.sequences);
      groups = static_cast<std::size_t>(std::lround(std::sqrt(pairs)));
    }
    const bool is_known = m.deviation && *m.deviation > 0.0;
    out.lines.push_back(
        {{m.method},
         {fmt::format("{}", groups)},
         {is_known ? fmt::format("{:.3f}", *m.deviation) : "-"},
         {is_known ? gain_text(power.smallest_effect(groups), *m.deviation) : "-"},
         {is_known ? groups_text(power.groups_needed(-std::log1p(-gain) / *m.deviation)) : "-"}});
  }
  out.notes.push_back("over " + unit_text(c));
  out.notes.push_back(fmt::format(
      "deviation: standard deviation of log ratios to {}{}; found with 80 %: the smallest gain "
      "shown in 80 % of the cases at {:g}, corrected for {} test{}, if log ratios are normal",
      c.options.baseline,
      c.has_strata                                ? " of two runs of a sequence"
      : c.sequences > 1 && c.sequences < c.groups ? " between groups, within sequences"
                                                  : " between groups",
      c.options.alpha,
      c.tests,
      c.tests == 1 ? "" : "s"));
  return out;
}

}  // namespace loopbench::harness
