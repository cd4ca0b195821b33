#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "harness/compare/compare.hpp"

namespace loopbench::harness {
namespace {

using Lines = std::vector<std::string>;

/// With this share of ties or more, 95 % intervals cover up to 98 % (mean_interval.hpp).
constexpr double kManyTies = 0.2;

bool is_tied(const MethodVerdict& m, const Comparison& c) {
  return static_cast<double>(m.ties) >= kManyTies * static_cast<double>(c.groups);
}

std::string comma_list(const Lines& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

Lines about_runs(const Comparison& c) {
  Lines out{"over " + unit_text(c)};
  if (c.runs < c.possible) {
    out[0] += fmt::format(" of {} possible: those on which every method has a value or failed",
                          c.possible);
  }
  if (c.copies > 0) {
    out.push_back(fmt::format("{} run{} the data of another and {} not counted",
                              c.copies,
                              c.copies == 1 ? " repeats" : "s repeat",
                              c.copies == 1 ? "is" : "are"));
  }
  if (c.options.over == Over::runs && c.known_groups < c.runs) {
    out.push_back(fmt::format(
        "assumes that all runs are independent (--over runs), although they form {} groups",
        c.known_groups));
  } else if (c.sequences < c.groups) {
    const std::string these =
        c.sequences == 1 ? "this sequence" : fmt::format("these {} sequences", c.sequences);
    out.push_back("claims hold for other instances of " + these +
                  "; --over sequences tests whether they hold for other sequences");
  }
  return out;
}

Lines about_methods(const Comparison& c) {
  Lines out;
  for (const Gap& gap : c.gaps) {
    const auto found = std::ranges::find(c.methods, gap.method, &MethodVerdict::method);
    const std::size_t fails = found == c.methods.end() ? 0 : found->fails;
    if (!gap.is_ranked) {
      out.push_back(fmt::format("{} is not ranked, it has no value: {}", gap.method, gap.why));
    } else if (fails > 0) {
      out.push_back(
          fmt::format("{} fails on {} of {} runs ({}): they count as losses in the tests and are "
                      "excluded from its median and ratio",
                      gap.method,
                      fails,
                      c.runs,
                      found->why_fails));
    } else {
      out.push_back(
          fmt::format("{} lacks {} of {} runs: {}", gap.method, gap.missing, c.possible, gap.why));
    }
  }
  const std::string coverage = coverage_text(c, methods_with_less_coverage(c));
  if (!coverage.empty()) {
    out.push_back(coverage + "; errors are over the parts that are covered");
  }
  if (!c.oracles.empty()) {
    out.push_back("not ranked, use the reference (oracle): " + comma_list(c.oracles));
  }
  if (!c.oracle_closures.empty()) {
    out.push_back("closures measured in the reference or selected by it (oracle): " +
                  comma_list(c.oracle_closures));
  }
  return out;
}

Lines about_ratios(const Comparison& c) {
  if (!c.is_ratio) {
    return {"some values are negative: no ratio; tests on plain differences decide alone"};
  }
  Lines out;
  Lines equal;
  Lines zero;
  Lines tied;
  std::map<std::string, Lines> without;  // by reason
  for (const MethodVerdict& m : c.methods) {
    if (m.has_interval && is_tied(m, c)) tied.push_back(m.method);
    if (m.has_equal_ratios) equal.push_back(m.method);
    if (!m.ratio && m.runs > 0) zero.push_back(m.method);
    if (m.ratio && !m.has_interval && m.wins + m.losses > 0) {
      without[m.why_no_interval].push_back(m.method);
    }
  }
  if (!zero.empty()) {
    out.push_back("no ratio to " + c.options.baseline +
                  " where an error is zero (or no run is common): " + comma_list(zero));
  }
  for (const auto& [why, methods] : without) {
    out.push_back("no interval for " + comma_list(methods) + ": " + why);
  }
  if (!equal.empty()) {
    out.push_back("most ratios to " + c.options.baseline +
                  " are equal to rounding, so that the groups can be copies of one another: " +
                  comma_list(equal));
  }
  if (!tied.empty()) {
    out.push_back(
        "interval too wide (of 95 %, it contains the ratio in up to 98 % of the cases), "
        "because a fifth of the groups or more tie with " +
        c.options.baseline + ": " + comma_list(tied));
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
      "ratio: geometric mean of {} / {}, {:g} % interval (Student's, corrected for "
      "the skewness of the logarithms, each at this level); effect: rank-biserial, "
      "positive is better",
      c.kind.better == metrics::Better::target ? fmt::format("|value - {:g}|", c.kind.target)
                                               : "value",
      c.options.baseline,
      level));
  out.push_back(fmt::format(
      "p against {}, ranks, groups and the verdict: one family of {} Wilcoxon signed-rank tests "
      "(Pratt), Holm-corrected; p is the larger of the test's and, where that is significant, 1.4 "
      "times that of the interval of the ratio; a method is proven better where p <= {:g} and the "
      "ratio agrees; fewer than 8 groups prove nothing; rank: range given the "
      "proven differences; group: methods that share a letter are not "
      "proven different; differences up to {:g} of a value are ties",
      c.options.baseline,
      c.pairs,
      c.options.alpha,
      c.options.relevant));
  if (c.pairs > 0 && c.groups < c.groups_needed) {
    out.push_back(
        fmt::format("no p: {} cannot prove a difference at {:g} in {} tests, {} are needed",
                    unit_text(c),
                    c.options.alpha,
                    c.pairs,
                    c.groups_needed));
  }
  for (std::string& line : about_ratios(c)) out.push_back(std::move(line));
  return out;
}

}  // namespace loopbench::harness
