#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "harness/base/counted.hpp"
#include "harness/compare/compare.hpp"

namespace loopbench::harness {
namespace {

using Lines = std::vector<std::string>;

std::string joined(const Lines& names) { return fmt::format("{}", fmt::join(names, ", ")); }

/// Whether a ratio is better than 1 by more than a relevant difference.
bool is_gain(double ratio, const Comparison& c) {
  const double gain = c.kind.better == metrics::Better::higher ? std::log(ratio) : -std::log(ratio);
  return gain > std::log1p(c.options.relevant);
}

std::string percent_on(const SequenceRatio& one) {
  return fmt::format("{} ({:.1f} %)", one.sequence, 100.0 * std::abs(one.ratio - 1.0));
}

/// Methods that are significantly worse than the baseline on a sequence, the worst first.
Lines about_sequences(const Comparison& c) {
  constexpr std::size_t kMost = 3;
  std::vector<std::pair<double, std::string>> found;
  for (const MethodVerdict& m : c.methods) {
    if (!m.ratio || m.is_beaten) continue;
    Lines better;
    Lines worse;
    double worst = 0.0;
    for (const SequenceRatio& one : m.ratio->by_sequence) {
      if (!one.is_clear) continue;
      if (is_gain(one.ratio, c)) better.push_back(percent_on(one));
      if (!is_gain(1.0 / one.ratio, c)) continue;
      worse.push_back(percent_on(one));
      worst = std::max(worst, std::abs(std::log(one.ratio)));
    }
    if (worse.empty()) continue;
    std::string text =
        m.method + " is significantly worse than " + c.options.baseline + " on " + joined(worse);
    if (!better.empty()) text += ", better on " + joined(better) + ": it depends on the sequence";
    found.emplace_back(-worst, text);
  }
  std::ranges::stable_sort(found, {}, &std::pair<double, std::string>::first);
  Lines out;
  for (const auto& [order, text] : found) {
    if (out.size() < kMost) out.push_back(text);
  }
  if (found.size() > kMost) {
    out.push_back(fmt::format("{} more methods are significantly worse than {} on a sequence",
                              found.size() - kMost,
                              c.options.baseline));
  }
  return out;
}

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
  const std::string unit = unit_text(c);
  if (c.has_strata) {
    out.push_back(unit +
                  ": those of a sequence are independent, methods are compared by rank sums within "
                  "sequences, and claims hold for more runs of them; --paired pairs runs of equal "
                  "names");
  } else if (!c.is_paired && c.sequences < c.runs) {
    out.push_back(unit + ": one observation is the median ratio of a sequence");
  } else if (c.sequences < c.groups) {
    out.push_back(fmt::format(
        "{}: one observation is a {}; claims hold for more of them on {}, and for other sequences "
        "only if --over sequences, with 6 sequences or more, shows them",
        unit,
        c.groups < c.runs ? "group of dependent runs" : "run",
        c.sequences == 1 ? "this sequence" : fmt::format("these {} sequences", c.sequences)));
  } else {
    out.push_back(fmt::format("{}: one observation is a {}; claims hold for more like them",
                              unit,
                              c.groups < c.runs ? "group of dependent runs" : "sequence"));
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
      out.push_back(m.method + ": ranks and the mean ratio to " + c.options.baseline +
                    " contradict each other, so that nothing is claimed");
    }
  }
  if (!zero.empty()) {
    out.push_back("no geometric mean ratio to " + c.options.baseline +
                  " where an error is zero (or no run is common): " + joined(zero));
  }
  const auto first = std::ranges::find_if(
      c.methods, [&](const MethodVerdict& m) { return m.method != c.options.baseline; });
  if (!first->ratio || first->ratio->by_sequence.empty()) return out;
  Lines ratios;
  for (const SequenceRatio& one : first->ratio->by_sequence) {
    ratios.push_back(fmt::format("{} {:.3f}{}", one.sequence, one.ratio, one.is_clear ? "*" : ""));
  }
  out.push_back(fmt::format("typical ratio {} / {} by sequence (*: significant): {}",
                            first->method,
                            c.options.baseline,
                            joined(ratios)));
  return out;
}

}  // namespace

Lines cautions(const Comparison& c) {
  Lines out = about_sequences(c);
  for (const Lines& lines : {about_methods(c), about_runs(c)}) {
    out.insert(out.end(), lines.begin(), lines.end());
  }
  return out;
}

Lines remarks(const Comparison& c) {
  Lines out = cautions(c);
  if (c.methods.empty()) return out;
  out.push_back(fmt::format(
      "ratio: typical {} / {} with its interval, {:g} % for all methods together, over several "
      "sequences of 6 groups or more their geometric mean; mean: geometric mean ratio over runs",
      c.kind.better == metrics::Better::target ? fmt::format("|value - {:g}|", c.kind.target)
                                               : "value",
      c.options.baseline,
      100.0 * (1.0 - c.options.alpha)));
  out.push_back(fmt::format(
      "p: {} against {}, a failure being the largest loss, corrected for {}; = shares the first "
      "place, > is significantly worse (Holm over all pairs at {:g}, or than a method that beats "
      "each rival); differences up to {:g} of a value are ties, up to {:g} are not relevant",
      c.has_strata ? "rank sums of runs within sequences"
                   : "Wilcoxon's exact signed-rank test of log ratios",
      c.options.baseline,
      counted(c.tests, "test"),
      c.options.alpha,
      c.options.tie,
      c.options.relevant));
  for (std::string& line : about_ratios(c)) out.push_back(std::move(line));
  return out;
}

}  // namespace loopbench::harness
