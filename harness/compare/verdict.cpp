#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "harness/base/counted.hpp"
#include "harness/compare/compare.hpp"

namespace loopbench::harness {
namespace {

using Names = std::vector<std::string>;

const MethodVerdict& find(const Comparison& c, const std::string& method) {
  return *std::ranges::find(c.methods, method, &MethodVerdict::method);
}

double largest_coverage(const Comparison& c) {
  double out = 0.0;
  for (const MethodVerdict& m : c.methods) out = std::max(out, m.coverage);
  return out;
}

/// Names of the methods for which `holds`.
template <class Holds>
Names names_where(const Comparison& c, Holds holds) {
  Names out;
  for (const MethodVerdict& m : c.methods) {
    if (holds(m)) out.push_back(m.method);
  }
  return out;
}

/// "a, b and c"; of more than three names the first two and "5 more".
std::string joined_names(Names names) {
  constexpr std::size_t kMost = 3;
  if (names.size() > kMost) {
    names[kMost - 1] = fmt::format("{} more", names.size() - (kMost - 1));
    names.resize(kMost);
  }
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    out += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  }
  return out;
}

/// One decimal, or two digits if that would be 0.0.
std::string percent_text(double percent) {
  return std::abs(percent) >= 0.95 || percent == 0.0 ? fmt::format("{:.1f}", percent + 0.0)
                                                     : fmt::format("{:.2g}", percent);
}

double percent_of(const MethodVerdict& m) { return 100.0 * (m.ratio->typical.estimate - 1.0); }

/// "below raw", for a score with a target "closer to 1 than raw".
std::string relation_text(bool is_below, const Comparison& c) {
  if (c.kind.better != metrics::Better::target) {
    return (is_below ? "below " : "above ") + c.options.baseline;
  }
  return fmt::format("{} {:g} than {}",
                     is_below ? "closer to" : "farther from",
                     c.kind.target,
                     c.options.baseline);
}

/// Difference of a method to the baseline: its ratio or, where none is defined, "better than raw on
/// 14 of 16 groups".
std::string distance_text(const MethodVerdict& m, const Comparison& c) {
  const std::size_t groups = m.wins + m.losses + m.ties;
  if (groups > 0 && m.ties == groups) return "equal to " + c.options.baseline;
  if (!m.ratio) {
    return fmt::format("{} than {} on {} of {} groups",
                       m.wins >= m.losses ? "better" : "worse",
                       c.options.baseline,
                       std::max(m.wins, m.losses),
                       groups);
  }
  const Interval& typical = m.ratio->typical;
  const double sign = typical.estimate <= 1.0 ? -100.0 : 100.0;
  std::string out = percent_text(std::abs(percent_of(m))) + " % " + relation_text(sign < 0.0, c);
  if (!m.ratio->has_interval) return out;
  const std::pair low_high = std::minmax({sign * (typical.low - 1.0), sign * (typical.high - 1.0)});
  return out +
         fmt::format(" [{}, {}]", percent_text(low_high.first), percent_text(low_high.second));
}

std::string contradiction_text(const MethodVerdict& m) {
  if (m.is_divided) return ", depends on the sequence";
  if (!m.is_contradicted) return "";
  return m.ratio && m.ratio->geometric_mean
             ? fmt::format(" on most runs, but the geometric mean ratio is {:.3f}",
                           *m.ratio->geometric_mean)
             : " on most runs, but not in the mean";
}

std::string why_no_comparison(const Comparison& c) {
  for (const Gap& gap : c.gaps) {
    if (!gap.is_ranked && gap.method == c.options.baseline) {
      return "the baseline " + gap.method + " has no value on any run: nothing is compared";
    }
  }
  return c.runs == 0 ? "no run has values of two methods: nothing is compared"
                     : "one method alone has values: nothing is compared";
}

/// The first method that is not the baseline: "dual is 13.5 % below raw".
std::string other_text(const Comparison& c) {
  const auto other = std::ranges::find_if(
      c.methods, [&](const MethodVerdict& m) { return m.method != c.options.baseline; });
  return other->method + " is " + result_text(c, *other);
}

/// Difference of several methods to the baseline: "43.2 to 44.1 % below raw", or that of the first.
std::string distances_text(const Comparison& c, const Names& methods) {
  double low = HUGE_VAL;
  double high = -HUGE_VAL;
  for (const std::string& name : methods) {
    const MethodVerdict& m = find(c, name);
    if (!m.ratio || m.is_divided || m.is_contradicted) continue;
    low = std::min(low, percent_of(m));
    high = std::max(high, percent_of(m));
  }
  if (!(high - low >= 1.0)) return result_text(c, find(c, methods.front()));
  if (low * high <= 0.0) {
    return fmt::format("{:+.1f} to {:+.1f} % of {}", low, high, c.options.baseline);
  }
  const auto [least, most] = std::minmax({std::abs(low), std::abs(high)});
  return fmt::format(
      "{} to {} % {}", percent_text(least), percent_text(most), relation_text(low < 0.0, c));
}

std::string best_text(const Comparison& c, const Names& first, bool has_baseline) {
  const std::string names = (has_baseline && first.size() == 1 ? "the baseline " : "") +
                            joined_names(first) + (first.size() == 1 ? " is best" : " are best");
  if (!has_baseline) return names + ", " + distances_text(c, first);
  return first.size() == 1 ? names + ": " + other_text(c) : names;
}

/// What holds although no method is best.
std::string shared_text(const Comparison& c, const Names& first, bool has_baseline) {
  const std::string covered = coverage_text(c, leaders_with_less_coverage(c));
  if (!covered.empty()) return "no method is best: " + covered;
  if (!has_baseline) {
    return joined_names(first) + " share the first place, " + distances_text(c, first);
  }
  const Names better = names_where(c, [](const MethodVerdict& m) { return m.beats_baseline; });
  if (better.empty()) {
    return "no method is significantly better than " + c.options.baseline + ": " + other_text(c);
  }
  return fmt::format("no method is best: {} {} {}",
                     joined_names(better),
                     better.size() == 1 ? "is" : "are",
                     distances_text(c, better));
}

}  // namespace

std::string result_text(const Comparison& c, const MethodVerdict& m) {
  std::string out = distance_text(m, c);
  if (m.p) out += *m.p < 0.0001 ? ", p < 0.0001" : fmt::format(", p = {:.2g}", *m.p);
  return out + contradiction_text(m);
}

std::string cannot_show_text(const Comparison& c) {
  const std::string unit = unit_text(c);
  return fmt::format("{} {} nothing: a test needs {}{}",
                     unit,
                     unit.starts_with("1 ") ? "decides" : "decide",
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

Names methods_with_less_coverage(const Comparison& c) {
  constexpr double kLess = 0.9;  // of the largest coverage
  return names_where(
      c, [&](const MethodVerdict& m) { return m.coverage < kLess * largest_coverage(c); });
}

Names leaders_with_less_coverage(const Comparison& c) {
  Names out = methods_with_less_coverage(c);
  std::erase_if(out, [&](const std::string& m) { return find(c, m).is_worse; });
  return out;
}

std::string coverage_text(const Comparison& c, const Names& methods) {
  std::string out;
  for (const std::string& method : methods) {
    out += fmt::format(
        "{}{} covers {:.0f} %", out.empty() ? "" : ", ", method, 100.0 * find(c, method).coverage);
  }
  if (out.empty()) return "";
  return out + fmt::format(" of the reference, others up to {:.0f} %", 100.0 * largest_coverage(c));
}

std::string title(const Comparison& c) {
  std::string out;
  const std::string relation = c.kind.relation == "translation" ? "" : c.kind.relation;
  const std::string axis = c.kind.axis == "3d" ? "" : c.kind.axis;
  for (const std::string& word : {c.kind.metric_label(), relation, axis, c.options.value}) {
    if (!word.empty()) out += (out.empty() ? "" : " ") + word;
  }
  return out + ", " + c.kind.times + ", " + c.kind.protocol;
}

std::string verdict(const Comparison& c) {
  if (c.methods.empty()) return why_no_comparison(c);
  const auto is_equal = [](const MethodVerdict& m) { return m.ties > 0 && m.wins + m.losses == 0; };
  if (std::ranges::all_of(c.methods, is_equal)) return "all methods are equal";
  if (!c.can_show) return other_text(c) + "; " + cannot_show_text(c);
  const Names first = names_where(c, [](const MethodVerdict& m) { return !m.is_worse; });
  const bool has_baseline = !find(c, c.options.baseline).is_worse;
  return (c.is_best ? best_text : shared_text)(c, first, has_baseline);
}

std::string statement(const Comparison& c) { return title(c) + ": " + verdict(c); }

}  // namespace loopbench::harness
