#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "harness/answers/compare/stated.hpp"
#include "harness/answers/compare/verdict.hpp"
#include "harness/sweep/text/counted.hpp"

namespace loopbench::harness {
namespace {

using Lines = std::vector<std::string>;

std::string joined(const Lines& names) { return fmt::format("{}", fmt::join(names, ", ")); }

void add_gaps(const Comparison& c, Lines& out) {
  std::vector<std::pair<std::string, Lines>> gaps;  // methods by what they lack
  for (const Gap& gap : c.gaps) {
    const MethodVerdict* method = c.find(gap.method);
    std::string what =
        gap.is_ranked
            ? fmt::format("no value on {} of {} runs ({})", gap.missing, c.possible, gap.why)
            : fmt::format("not ranked, no value ({})", gap.why);
    if (method != nullptr && method->fails > 0)
      what += "; changes are over the runs that both methods solved";
    const auto same = std::ranges::find(gaps, what, &std::pair<std::string, Lines>::first);
    (same == gaps.end() ? gaps.emplace_back(what, Lines()) : *same).second.push_back(gap.method);
  }
  for (const auto& [what, methods] : gaps) out.push_back(what + ": " + joined(methods));
}

}  // namespace

std::string cannot_show_text(const Comparison& c) {
  std::string unit = unit_text(c);
  if (unit == "1 sequence") unit = "One recording";
  return fmt::format("{}; a test needs {}{}",
                     unit,
                     c.groups_needed,
                     c.is_independent ? " runs of each method and sequence" : "");
}

std::string unit_text(const Comparison& c) {
  if (c.groups < c.runs) {
    const bool are_sequences = c.options.over == Over::sequences && c.groups == c.sequences;
    return counted(c.groups, are_sequences ? "sequence" : "group") + " (" + counted(c.runs, "run") +
           ")";
  }
  if (c.sequences == c.runs) return counted(c.runs, "sequence");
  return counted(c.runs, "run") + " of " + counted(c.sequences, "sequence");
}

std::string coverage_text(const Comparison& c, bool of_first) {
  std::string out;
  double largest = 0.0;
  for (const MethodVerdict& m : c.methods) {
    largest = std::max(largest, m.coverage);
    if (!m.covers_less || (of_first && m.is_worse)) continue;
    out += out.empty() ? "" : ", ";
    out += fmt::format("{} covers {:.0f} %", shown_name(m), 100.0 * m.coverage);
  }
  if (out.empty()) return "";
  return out + fmt::format(" of the reference, others up to {:.0f} %", 100.0 * largest);
}

Lines limitations(const Comparison& c) {
  Lines out;
  const auto list = [&](const std::string& what, const Lines& names) {
    if (!names.empty()) out.push_back(what + ": " + joined(names));
  };
  add_gaps(c, out);
  const std::string coverage = coverage_text(c, false);
  if (!coverage.empty()) out.push_back(coverage + "; errors are over the parts that are covered");
  list("not ranked because they use the reference (oracle)", c.oracles);
  list("closures measured in the reference, or selected by it (oracle)", c.oracle_closures);
  if (c.runs < c.possible) {
    out.push_back(
        fmt::format("{} of {} possible runs are compared: those on which {}",
                    c.runs,
                    c.possible,
                    c.is_paired ? "two methods have a value or failed" : "a method has a value"));
  }
  if (c.copies > 0) {
    out.push_back(fmt::format("{} run{} the data of another and {} not counted",
                              c.copies,
                              c.copies == 1 ? " repeats" : "s repeat",
                              c.copies == 1 ? "is" : "are"));
  }
  list("not deterministic: values differ on equal data", c.unstable);
  list("not independent, one recording (equal reference or group)", c.same_recordings);
  return out;
}

Lines remarks(const Comparison& c, bool in_paper) {
  Lines out = limitations(c);
  if (c.methods.empty()) return out;
  out.push_back(fmt::format(
      "change: typical {} / {}, minus 1 (Hodges-Lehmann estimate; geometric mean over sequences "
      "with several groups)",
      c.kind.better == metrics::Better::target ? fmt::format("|value - {:g}|", c.kind.target)
                                               : "value",
      baseline_name(c)));
  if (std::ranges::any_of(c.methods, &MethodVerdict::is_stated))
    out.emplace_back(in_paper ? kStatedInPaper : kStatedNote);
  if (!c.can_show) return out;
  out.push_back(fmt::format(
      "p: {} against {}, corrected for {}",
      c.is_ratio ? "randomization test of log ratios" : "randomization test of differences",
      baseline_name(c),
      counted(c.tests, "test")));
  if (!c.is_ratio) out.push_back("no change is given for methods with negative values");
  return out;
}

}  // namespace loopbench::harness
