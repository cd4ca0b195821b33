#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "harness/compare/ratio_text.hpp"

namespace loopbench::harness {
namespace {

using Lines = std::vector<std::string>;

std::string joined(const Lines& names) { return fmt::format("{}", fmt::join(names, ", ")); }

Lines about_runs(const Comparison& c) {
  Lines out;
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
  if (c.has_strata) {
    out.push_back(
        fmt::format("the runs of a sequence are independent: methods are compared by rank sums "
                    "within {}, for more runs of {}; --paired pairs runs of equal names",
                    c.sequences == 1 ? "it" : "the sequences",
                    c.sequences == 1 ? "it" : "them"));
  } else if (!c.is_paired && c.sequences < c.runs) {
    out.push_back(
        "the runs of a sequence are independent, and most sequences have one: an "
        "observation is the median ratio of a sequence");
  } else if (c.sequences < c.groups) {
    const std::string these =
        c.sequences == 1 ? "this sequence" : fmt::format("these {} sequences", c.sequences);
    out.push_back("claims hold for more runs of " + these +
                  "; --over sequences tests whether they hold for other sequences");
  }
  return out;
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

Lines about_methods(const Comparison& c) {
  Lines out;
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
  return out;
}

/// "room 0.52, city 0.61".
std::string by_sequence(const Ratio& ratio) {
  Lines out;
  for (const SequenceRatio& one : ratio.by_sequence) {
    out.push_back(fmt::format("{} {:.3f}", one.sequence, one.ratio));
  }
  return joined(out);
}

Lines about_ratios(const Comparison& c) {
  Lines out;
  if (!c.is_ratio) {
    out.push_back(
        "some values are negative: no ratio for their methods; tests of plain differences");
  }
  Lines zero;
  for (const MethodVerdict& m : c.methods) {
    if (m.ratio && !m.ratio->geometric_mean && m.runs > 0) zero.push_back(m.method);
    if (m.is_contradicted) {
      out.push_back(m.method + ": ranks and the geometric mean ratio to " + c.options.baseline +
                    " contradict each other, so that nothing is claimed");
    }
  }
  if (!zero.empty()) {
    out.push_back("no geometric mean ratio to " + c.options.baseline +
                  " where an error is zero (or no run is common): " + joined(zero));
  }
  const MethodVerdict& first = c.methods.front();
  if (first.ratio && !first.ratio->by_sequence.empty() && first.method != c.options.baseline) {
    out.push_back(fmt::format("mean ratio {} / {} by sequence: {}",
                              first.method,
                              c.options.baseline,
                              by_sequence(*first.ratio)));
  }
  return out;
}

}  // namespace

Lines conditions(const Comparison& c) {
  Lines out = about_runs(c);
  for (std::string& line : about_methods(c)) out.push_back(std::move(line));
  return out;
}

Lines remarks(const Comparison& c) {
  Lines out = conditions(c);
  if (c.methods.empty()) return out;
  const double level = 100.0 * (1.0 - c.options.alpha);
  out.push_back(fmt::format(
      "ratio: typical {} / {} (Hodges-Lehmann) with its interval, which inverts the test, {:g} % "
      "for "
      "all methods together; mean: geometric mean ratio over runs on which both have values; "
      "behind: "
      "typical ratio to the first method, less 1",
      c.kind.better == metrics::Better::target ? fmt::format("|value - {:g}|", c.kind.target)
                                               : "value",
      c.options.baseline,
      level));
  out.push_back(fmt::format(
      "p: {} against {}, a failure being the largest loss, corrected for {} test{}; significantly "
      "better: p <= {:g}, and the geometric mean does not disagree; differences up to {:g} of a "
      "value are ties, up to {:g} are not relevant for \"best\"",
      c.has_strata ? "rank sums of runs within sequences"
                   : "Wilcoxon's exact signed-rank test of log ratios",
      c.options.baseline,
      c.tests,
      c.tests == 1 ? "" : "s",
      c.options.alpha,
      c.options.tie,
      c.options.relevant));
  for (std::string& line : about_ratios(c)) out.push_back(std::move(line));
  return out;
}

}  // namespace loopbench::harness
