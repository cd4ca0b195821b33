#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "harness/base/counted.hpp"
#include "harness/compare/verdict.hpp"

namespace loopbench::harness {
namespace {

using Lines = std::vector<std::string>;

std::string joined(const Lines& names) { return fmt::format("{}", fmt::join(names, ", ")); }

double largest_coverage(const Comparison& c) {
  double out = 0.0;
  for (const MethodVerdict& m : c.methods) out = std::max(out, m.coverage);
  return out;
}

void add_runs(const Comparison& c, Lines& out) {
  if (c.runs < c.possible) {
    out.push_back(
        fmt::format("{} of {} possible runs: those on which two methods have a value or failed",
                    c.runs,
                    c.possible));
  }
  if (c.copies > 0) {
    out.push_back(fmt::format("{} run{} the data of another and {} not counted",
                              c.copies,
                              c.copies == 1 ? " repeats" : "s repeat",
                              c.copies == 1 ? "is" : "are"));
  }
  if (!c.unstable.empty()) {
    out.push_back("not deterministic, values differ on equal data: " + joined(c.unstable));
  }
  if (!c.same_recordings.empty()) {
    out.push_back(
        "not independent, because the references are one recording (equal positions, or the stated "
        "group): " +
        joined(c.same_recordings));
  }
}

/// What a method lacks, for methods that lack the same.
std::string gap_text(const Gap& gap, const Comparison& c) {
  if (!gap.is_ranked) return fmt::format("not ranked, no value ({})", gap.why);
  const auto found = std::ranges::find(c.methods, gap.method, &MethodVerdict::method);
  if (found == c.methods.end() || found->fails == 0) {
    return fmt::format("no value on {} of {} runs ({})", gap.missing, c.possible, gap.why);
  }
  return fmt::format(
      "failed on {} of {} runs ({}), which are losses in the tests and not in median and mean",
      found->fails,
      c.runs,
      found->why_fails);
}

void add_methods(const Comparison& c, Lines& out) {
  std::vector<std::pair<std::string, Lines>> gaps;  // methods by what they lack
  for (const Gap& gap : c.gaps) {
    const std::string text = gap_text(gap, c);
    const auto same = std::ranges::find(gaps, text, &std::pair<std::string, Lines>::first);
    (same == gaps.end() ? gaps.emplace_back(text, Lines()) : *same).second.push_back(gap.method);
  }
  for (const auto& [text, methods] : gaps) out.push_back(text + ": " + joined(methods));
  const std::string coverage = coverage_text(c, methods_with_less_coverage(c));
  if (!coverage.empty()) {
    out.push_back(coverage + "; errors are over the parts that are covered");
  }
  if (!c.oracles.empty()) {
    out.push_back("not ranked, use the reference (oracle): " + joined(c.oracles));
  }
  if (!c.oracle_closures.empty()) {
    out.push_back("closures measured in the reference or selected by it (oracle): " +
                  joined(c.oracle_closures));
  }
}

void add_ratios(const Comparison& c, Lines& out) {
  if (!c.is_ratio) {
    out.push_back(
        "some values are negative: no ratio for their methods; tests of plain differences");
  }
  Lines zero;
  for (const MethodVerdict& m : c.methods) {
    if (m.ratio && !m.ratio->geometric_mean && m.runs > 0) zero.push_back(m.method);
    if (m.is_contradicted) {
      out.push_back(m.method + ": ranks and the mean ratio to " + c.options.baseline +
                    " contradict each other, so that nothing is claimed");
    }
  }
  if (!zero.empty()) {
    out.push_back("no geometric mean ratio to " + c.options.baseline +
                  " where an error is zero (or no run is common): " + joined(zero));
  }
}

}  // namespace

std::string cannot_show_text(const Comparison& c) {
  std::string unit = unit_text(c);
  if (unit == "1 sequence") unit = "One recording";
  return fmt::format("{}; a test needs {}{}",
                     unit,
                     c.groups_needed,
                     c.has_strata ? " runs of each method and sequence" : "");
}

std::string unit_text(const Comparison& c) {
  if (c.options.over == Over::sequences && c.groups == c.sequences && c.groups < c.runs) {
    return counted(c.groups, "sequence") + " (" + counted(c.runs, "run") + ")";
  }
  if (c.groups < c.runs) return counted(c.groups, "group") + " (" + counted(c.runs, "run") + ")";
  // Two runs of one sequence, of which one counts, are not "1 sequence of 2 possible".
  const bool has_one_run_each =
      c.sequences == c.runs && (c.runs == c.possible || c.possible_sequences == c.possible);
  if (has_one_run_each) return counted(c.runs, "sequence");
  return counted(c.runs, "run") + (c.runs > 1 ? " of " + counted(c.sequences, "sequence") : "");
}

Lines methods_with_less_coverage(const Comparison& c) {
  constexpr double kLess = 0.9;  // of the largest coverage
  Lines out;
  for (const MethodVerdict& m : c.methods) {
    if (m.coverage < kLess * largest_coverage(c)) out.push_back(m.method);
  }
  return out;
}

Lines leaders_with_less_coverage(const Comparison& c) {
  Lines out = methods_with_less_coverage(c);
  std::erase_if(out, [&](const std::string& method) {
    return std::ranges::find(c.methods, method, &MethodVerdict::method)->is_worse;
  });
  return out;
}

std::string coverage_text(const Comparison& c, const Lines& methods) {
  std::string out;
  for (const std::string& method : methods) {
    const auto found = std::ranges::find(c.methods, method, &MethodVerdict::method);
    out += fmt::format(
        "{}{} covers {:.0f} %", out.empty() ? "" : ", ", method, 100.0 * found->coverage);
  }
  if (out.empty()) return "";
  return out + fmt::format(" of the reference, others up to {:.0f} %", 100.0 * largest_coverage(c));
}

Lines limitations(const Comparison& c) {
  Lines out;
  add_methods(c, out);
  add_runs(c, out);
  return out;
}

Lines remarks(const Comparison& c) {
  Lines out = limitations(c);
  if (c.methods.empty()) return out;
  out.push_back(fmt::format(
      "ratio: typical {} / {} (Hodges-Lehmann; over several sequences of 6 groups or more their "
      "geometric mean), intervals for all methods together; mean: geometric mean ratio over runs",
      c.kind.better == metrics::Better::target ? fmt::format("|value - {:g}|", c.kind.target)
                                               : "value",
      c.options.baseline));
  const std::string test = c.has_strata
                               ? "rank sums of runs within sequences"
                               : fmt::format("signed-rank test (exact up to {} groups) of {}",
                                             kMostExact,
                                             c.is_ratio ? "log ratios" : "differences");
  out.push_back(fmt::format(
      "p: {} against {}, corrected for {}; a failure is a loss, differences up to {:g} of a value "
      "are ties; >: Holm over all pairs at {:g}, or worse than a method that beats each rival",
      test,
      c.options.baseline,
      counted(c.tests, "test"),
      c.options.tie,
      c.options.alpha));
  add_ratios(c, out);
  return out;
}

}  // namespace loopbench::harness
