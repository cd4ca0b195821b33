#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/compare/compare.hpp"

namespace loopbench::harness {
namespace {

std::string joined_names(const std::vector<std::string>& names, const char* last = " and ") {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    out += (i == 0 ? "" : i + 1 == names.size() ? last : ", ") + names[i];
  }
  return out;
}

std::string p_sentence(double p) {
  return p < 0.0001 ? "p < 0.0001" : fmt::format("p = {:.2g}", p);
}

const MethodVerdict* find(const Comparison& comparison, const std::string& method) {
  const auto found = std::ranges::find(comparison.methods, method, &MethodVerdict::method);
  return found == comparison.methods.end() ? nullptr : &*found;
}

double largest_coverage(const Comparison& c) {
  double out = 0.0;
  for (const MethodVerdict& m : c.methods) out = std::max(out, m.coverage);
  return out;
}

/// Names of the methods for which `holds`.
template <class Holds>
std::vector<std::string> names_where(const Comparison& c, Holds holds) {
  std::vector<std::string> out;
  for (const MethodVerdict& m : c.methods) {
    if (holds(m)) out.push_back(m.method);
  }
  return out;
}

/// One decimal, or two digits if that would be 0.0.
std::string percent_text(double percent) {
  return std::abs(percent) >= 0.95 || percent == 0.0 ? fmt::format("{:.1f}", percent)
                                                     : fmt::format("{:.2g}", percent);
}

/// "better than raw on 14 of 16 groups", where no ratio is defined.
std::string without_ratio(const MethodVerdict& method, const Comparison& c) {
  const bool is_better = method.wins > method.losses;
  const std::size_t groups = method.wins + method.losses + method.ties;
  if (method.wins == method.losses) {
    return fmt::format("better than {} on as many groups as worse ({} of {})",
                       c.options.baseline,
                       method.wins,
                       groups);
  }
  return fmt::format("{} than {} on {} of {} groups",
                     is_better ? "better" : "worse",
                     c.options.baseline,
                     std::max(method.wins, method.losses),
                     groups);
}

/// "12.3 % below raw [8.1, 15.2]": difference of a method to the baseline. For a score with a
/// target "12.3 % closer to 1 than raw".
std::string distance(const MethodVerdict& method, const Comparison& c) {
  const CompareOptions& options = c.options;
  const bool is_tie = method.ties > 0 && method.wins + method.losses == 0;
  // A method that fails on some runs has losses although its values are equal.
  const bool is_equal = method.ratio && method.fails > 0 &&
                        std::abs(method.ratio->estimate - 1.0) <= options.relevant;
  if (is_tie || is_equal) return "equal to " + options.baseline;
  if (!method.ratio) return without_ratio(method, c);
  const double sign = method.ratio->estimate <= 1.0 ? -100.0 : 100.0;
  const auto percent = [&](double ratio) { return sign * (ratio - 1.0); };
  const bool has_target = c.kind.better == metrics::Better::target;
  const std::string relation =
      !has_target
          ? (sign < 0.0 ? "below" : "above")
          : fmt::format("{} {:g} than", sign < 0.0 ? "closer to" : "farther from", c.kind.target);
  std::string out = fmt::format(
      "{} % {} {}", percent_text(percent(method.ratio->estimate)), relation, options.baseline);
  if (method.has_interval) {
    const double low = percent(method.ratio->low);
    const double high = percent(method.ratio->high);
    out += fmt::format(
        " [{}, {}]", percent_text(std::min(low, high)), percent_text(std::max(low, high)));
  }
  return out;
}

/// ", on 8 of 10 runs; fails 2"; empty without failures.
std::string failures_text(const Comparison& c, const MethodVerdict& method) {
  if (method.fails == 0) return "";
  return fmt::format(", on {} of {} runs; fails {}", method.runs, c.runs, method.fails);
}

/// ", but raw fails on 6 of 8 runs": why a method ranks before the baseline although its error is
/// larger where both have one.
std::string baseline_failures_text(const Comparison& c, const MethodVerdict& method) {
  const MethodVerdict& baseline = *find(c, c.options.baseline);
  const bool is_worse = method.ratio && method.ratio->estimate > 1.0 + c.options.relevant;
  if (!is_worse || baseline.fails <= method.fails) return "";
  return fmt::format(", but {} fails on {} of {} runs", baseline.method, baseline.fails, c.runs);
}

/// distance() with p and the excluded runs, for a method that ranks before the baseline.
std::string result(const Comparison& c, const MethodVerdict& method) {
  std::string out = distance(method, c);
  if (method.p) out += ", " + p_sentence(*method.p);
  if (method.p && !method.beats_baseline) out += ", not proven";
  return out + failures_text(c, method) + baseline_failures_text(c, method);
}

std::string why_no_comparison(const Comparison& c) {
  for (const Gap& gap : c.gaps) {
    if (!gap.is_ranked && gap.method == c.options.baseline) {
      return "the baseline " + gap.method + " has no value on any run: nothing is compared";
    }
  }
  if (c.runs == 0) return "no run has a value of every method: nothing is compared";
  return "one method alone has values: nothing is compared";
}

/// ": B is 12.3 % above A [8.1, 15.2], p = 0.004" if A is the baseline and B the only other method.
std::string only_other(const Comparison& c) {
  if (c.methods.size() != 2) return "";
  const bool is_first = c.methods.front().method != c.options.baseline;
  const MethodVerdict& other = is_first ? c.methods.front() : c.methods.back();
  return ": " + other.method + " is " + distance(other, c) +
         (other.p ? ", " + p_sentence(*other.p) : "") + failures_text(c, other);
}

std::string best_text(const Comparison& c, const std::vector<std::string>& leaders) {
  const MethodVerdict* baseline = find(c, c.options.baseline);
  std::string out = joined_names(leaders);
  out += leaders.size() == 1 ? " is best" : " are best and equal";
  if (leaders.size() == c.methods.size()) return "all methods are equal";
  if (baseline->is_leader) {
    out = (leaders.size() == 1 ? "the baseline " : "") + out + only_other(c);
  } else {
    out += ": " + result(c, c.methods.front());
  }
  return out + "; proven better than " +
         (c.methods.size() - leaders.size() == 1 ? "the other method"
                                                 : "each of the other methods");
}

/// Claims that hold although no method is proven best.
std::string undecided_text(const Comparison& c, const std::vector<std::string>& leaders) {
  const MethodVerdict& first = c.methods.front();
  const auto others = names_where(c, [](const MethodVerdict& m) { return !m.is_leader; });
  const auto open =
      names_where(c, [](const MethodVerdict& m) { return !m.is_leader && !m.is_beaten_by_leader; });
  const auto winners = names_where(c, [](const MethodVerdict& m) { return m.beats_baseline; });
  const std::string rest = open.size() == others.size() && open.size() > 1
                               ? "any other method"
                               : joined_names(open, " or ");
  if (find(c, c.options.baseline)->is_leader) {
    return "no method is proven better than the baseline " + c.options.baseline +
           "; it is not proven better than " + rest + only_other(c);
  }
  const std::string lead =
      joined_names(leaders) + (leaders.size() == 1 ? " is " : " are equal, ") + result(c, first);
  if (first.beats_baseline) {
    return "no method is proven best: " + lead + ", but not proven better than " + rest;
  }
  if (winners.empty()) {
    return "no method is proven better than the baseline " + c.options.baseline + ": " + lead;
  }
  return "no method is proven best: proven better than " + c.options.baseline +
         (winners.size() == 1 ? " is " : " are ") + joined_names(winners) + "; " + lead;
}

}  // namespace

std::string unit_text(const Comparison& c) {
  const auto plural = [](std::size_t n, const std::string& one) {
    return fmt::format("{} {}{}", n, one, n == 1 ? "" : "s");
  };
  if (c.options.over == Over::sequences && c.groups == c.sequences && c.groups < c.runs) {
    return plural(c.groups, "sequence") + " (" + plural(c.runs, "run") + ")";
  }
  if (c.groups < c.runs) return plural(c.groups, "group") + " (" + plural(c.runs, "run") + ")";
  // Two runs of one sequence, of which one counts, are not "1 sequence of 2 possible".
  const bool has_one_run_each =
      c.sequences == c.runs && (c.runs == c.possible || c.possible_sequences == c.possible);
  return plural(c.runs, has_one_run_each ? "sequence" : "run");
}

std::vector<std::string> methods_with_less_coverage(const Comparison& c) {
  constexpr double kLess = 0.9;  // of the largest coverage
  return names_where(
      c, [&](const MethodVerdict& m) { return m.coverage < kLess * largest_coverage(c); });
}

std::string coverage_text(const Comparison& c, const std::vector<std::string>& methods) {
  std::string out;
  for (const std::string& method : methods) {
    out += fmt::format(
        "{}{} covers {:.0f} %", out.empty() ? "" : ", ", method, 100.0 * find(c, method)->coverage);
  }
  if (out.empty()) return "";
  return out + fmt::format(" of the reference, others up to {:.0f} %", 100.0 * largest_coverage(c));
}

std::string verdict(const Comparison& c) {
  if (c.methods.empty()) return why_no_comparison(c);
  const auto leaders = names_where(c, [](const MethodVerdict& m) { return m.is_leader; });
  std::vector<std::string> partial = methods_with_less_coverage(c);
  std::erase_if(partial, [&](const std::string& m) { return std::ranges::count(leaders, m) == 0; });
  const std::string covered = coverage_text(c, partial);
  const std::string over = (covered.empty() ? "" : "; but " + covered) + "; over " + unit_text(c);
  if (c.is_best_proven || leaders.size() == c.methods.size()) return best_text(c, leaders) + over;
  if (c.groups >= c.groups_needed) return undecided_text(c, leaders) + over;
  const MethodVerdict& first = c.methods.front();
  const std::string lead =
      find(c, c.options.baseline)->is_leader
          ? "the baseline " + c.options.baseline + " ranks first" + only_other(c)
          : joined_names(leaders) + (leaders.size() == 1 ? " is " : " are ") + result(c, first);
  return fmt::format(
      "nothing is proven: {}{}, but {} cannot prove a difference among {} methods at "
      "{:g} ({} are needed)",
      lead,
      covered.empty() ? "" : ", and " + covered,
      unit_text(c),
      c.methods.size(),
      c.options.alpha,
      c.groups_needed);
}

}  // namespace loopbench::harness
