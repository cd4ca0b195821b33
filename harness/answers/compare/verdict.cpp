#include "harness/answers/compare/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace loopbench::harness {
namespace {

using Names = std::vector<std::string>;

template <class Holds>
Names names_where(const Comparison& c, Holds holds) {
  Names out;
  for (const MethodVerdict& m : c.methods) {
    if (holds(m)) out.push_back(m.method);
  }
  return out;
}

const MethodVerdict& first_other(const Comparison& c) {
  return *std::ranges::find_if(
      c.methods, [&](const MethodVerdict& m) { return m.method != c.options.baseline; });
}

/// What an observation is.
const char* observed_unit(const Comparison& c) {
  if (c.groups == c.runs) return "runs";
  return c.options.over == Over::sequences ? "sequences" : "groups";
}

/// Why the difference of a method to the baseline is no number.
std::string without_number(const Comparison& c, const MethodVerdict& m) {
  if (m.wins + m.losses + m.ties == 0)
    return "not comparable with " + baseline_name(c) + " (no run that both solved)";
  return fmt::format("{} than {} on {} of {} {}",
                     m.wins >= m.losses ? "better" : "worse",
                     baseline_name(c),
                     std::max(m.wins, m.losses),
                     m.wins + m.losses + m.ties,
                     c.is_independent ? "pairs of runs" : observed_unit(c));
}

/// The end nearer to zero first, of changes that are mostly below zero if `is_below`.
std::pair<double, double> ordered(const Change& change, bool is_below) {
  return is_below ? std::pair(change.high, change.low) : std::pair(change.low, change.high);
}

/// "37 to 44", of changes of which `sign` times is printed.
std::string range_text(const Change& change, double sign) {
  const auto [first, last] = ordered(change, sign < 0.0);
  return percent_text(sign * first) + " to " + percent_text(sign * last);
}

/// Why a method has a change without an interval, where others can have one.
std::string no_interval(const Comparison& c, const VerdictGroup& of) {
  const MethodVerdict& m = *c.find(of.methods.front());
  const bool are_few = !c.is_independent && m.wins + m.losses + m.ties < c.groups_needed;
  return are_few ? fmt::format(" (too few {} for a test)", observed_unit(c))
                 : fmt::format(" ({:g} %: unbounded)", 100.0 * (1.0 - c.options.alpha));
}

/// "37 to 44 % below raw (95 %: 30 to 51)"; of a score with a target "closer to 1 than raw".
std::string change_text(const Comparison& c, const VerdictGroup& of) {
  const Change& change = *of.all;
  const bool is_below = change.low + change.high <= 0.0;
  const double sign = is_below ? -1.0 : 1.0;
  const auto side = [&](bool below) {
    if (c.kind.better != metrics::Better::target) return std::string(below ? "below" : "above");
    return fmt::format("{} {:g} than", below ? "closer to" : "farther from", c.kind.target);
  };
  const bool is_range = change.high - change.low > 1.0;
  std::string out;
  if (is_range && change.low < 0.0 && change.high > 0.0) {
    out = fmt::format("{} % {} to {} % {}",
                      percent_text(change.high),
                      side(false),
                      percent_text(-change.low),
                      side(true));
  } else {
    out =
        is_range ? range_text(change, sign) : percent_text(0.5 * sign * (change.low + change.high));
    out += " % " + side(is_below);
  }
  out += " " + baseline_name(c);
  if (!of.interval) return out + (c.can_show && of.methods.size() == 1 ? no_interval(c, of) : "");
  return out + fmt::format(" ({:g} %: {})",
                           100.0 * (1.0 - c.options.alpha),
                           range_text(*of.interval, sign));
}

/// " on 6 of 8 runs; b fails on 2", of the named methods and the baseline; empty without failures.
std::string failures_text(const Comparison& c, const std::vector<const MethodVerdict*>& members) {
  std::string out;
  std::vector<const MethodVerdict*> all = members;
  const MethodVerdict* const baseline = c.find(c.options.baseline);
  if (std::ranges::count(all, baseline) == 0) all.push_back(baseline);
  for (const MethodVerdict* m : all) {
    if (m->fails == 0) continue;
    out += fmt::format("{}{} fails on {}", out.empty() ? "; " : ", ", shown_name(*m), m->fails);
    if (m->fails_more) out += " (significantly more often)";
  }
  if (out.empty()) return "";
  if (members.size() > 1 || c.is_independent) return out + fmt::format(" of {} runs", c.runs);
  return fmt::format(" on {} of {} runs", members.front()->common, c.runs) + out;
}

std::string names_text(const Comparison& c, const Names& methods) {
  std::vector<const MethodVerdict*> members;
  for (const MethodVerdict& m : c.methods) {
    if (std::ranges::count(methods, m.method) > 0) members.push_back(&m);
  }
  const VerdictGroup group = group_of(members, {}, c.options.baseline);
  const std::string out = group.all ? change_text(c, group) : without_number(c, *members.front());
  return out + failures_text(c, members);
}

std::string why_no_comparison(const Comparison& c) {
  const auto gap = std::ranges::find(c.gaps, c.options.baseline, &Gap::method);
  if (gap != c.gaps.end() && !gap->is_ranked)
    return "the baseline " + gap->method + " has no value on any run: nothing is compared";
  return c.runs == 0 ? "no run has values of two methods: nothing is compared"
                     : "one method alone has values: nothing is compared";
}

/// "6 runs of 1 sequence cannot decide among 4 methods: 7 would".
std::string cannot_decide_text(const Comparison& c) {
  const bool are_common = c.common == c.groups || c.is_independent;
  return fmt::format(
      "{}{} cannot decide {} {} methods: {}{} would",
      unit_text(c),
      are_common ? "" : fmt::format(", of which two methods solved at most {},", c.common),
      c.tests == 1 ? "between" : "among",
      c.tests + 1,
      c.groups_needed,
      c.is_independent ? " of each method and sequence" : "");
}

/// "open 0.064 m, other 0.121 m (+91 %). One recording; a test needs 6".
std::string too_few_text(const Comparison& c) {
  constexpr std::size_t kMost = 3;
  if (c.groups > 1) {
    const MethodVerdict& m = first_other(c);
    std::string out =
        cannot_decide_text(c) + "; " + shown_name(m) + " is " + names_text(c, {m.method});
    if (m.ratio && failures_text(c, {&m}).empty())
      out += fmt::format(" on {} of {}", std::max(m.wins, m.losses), m.wins + m.losses + m.ties);
    return out;
  }
  std::vector<const MethodVerdict*> methods{c.find(c.options.baseline)};
  for (const MethodVerdict& m : c.methods) {
    if (&m != methods.front()) methods.push_back(&m);
  }
  std::string out;
  for (std::size_t i = 0; i < std::min(kMost, methods.size()); ++i) {
    const MethodVerdict& m = *methods[i];
    out += (i == 0 ? "" : ", ") + shown_name(m);
    out += m.runs == 0 ? " failed" : fmt::format(" {:.3g}", m.median);
    if (m.runs > 0 && !c.kind.unit.empty()) out += " " + c.kind.unit;
    if (i == 0 || !m.ratio) continue;
    const double percent = 100.0 * (m.ratio->typical.estimate - 1.0);
    out += " (" + text({percent, percent}, 0.0) + " %)";
  }
  if (methods.size() > kMost) out += fmt::format(", {} more", methods.size() - kMost);
  return out + ". " + cannot_show_text(c);
}

std::vector<const MethodVerdict*> verdicts_of(const Comparison& c, const Names& methods) {
  std::vector<const MethodVerdict*> out;
  for (const std::string& name : methods) out.push_back(c.find(name));
  return out;
}

/// The corrector of which these are all methods with a smoother, three or more; otherwise empty.
std::string common_corrector(const Comparison& c, const Names& methods) {
  const SharedText corrector = c.find(methods.front())->parts.corrector;
  const auto has_smoother = [&](const MethodVerdict& m) {
    return m.parts.corrector == corrector && !m.parts.smoother.empty() && !m.is_stated;
  };
  const bool are_all = !corrector.empty() && methods.size() > 2 &&
                       methods.size() == names_where(c, has_smoother).size() &&
                       std::ranges::all_of(methods, [&](const std::string& name) {
                         return has_smoother(*c.find(name));
                       });
  return are_all ? corrector.text() : "";
}

/// "dual with a smoother" for all methods of that kind, "a, b and 3 more" otherwise.
std::string common_name(const Comparison& c, const Names& methods) {
  const std::string corrector = common_corrector(c, methods);
  return corrector.empty() ? short_names(verdicts_of(c, methods), " and ")
                           : corrector + " with a smoother";
}

std::string best_text(const Comparison& c, const Names& first, bool has_baseline) {
  const std::string name = common_name(c, first);
  const bool is_one = first.size() == 1 || !common_corrector(c, first).empty();
  const char* place = c.is_best ? " are best" : " share first place";
  if (is_one) place = " is best";
  if (!has_baseline) return name + place + ", " + names_text(c, first);
  if (first.size() > 1) return name + place;
  const MethodVerdict& next = first_other(c);
  return "the baseline " + name + " is best: " + shown_name(next) + " is " +
         names_text(c, {next.method});
}

/// Where the baseline shares the first place.
std::string shared_text(const Comparison& c) {
  const Names better = names_where(c, [](const MethodVerdict& m) { return m.beats_baseline; });
  if (!better.empty()) {
    return fmt::format("no method is best: {} {} {}",
                       common_name(c, better),
                       better.size() == 1 ? "is" : "are",
                       names_text(c, better));
  }
  const MethodVerdict& m = first_other(c);
  const bool is_open = !m.fails_more && std::ranges::none_of(c.methods, &MethodVerdict::is_worse);
  return fmt::format("{}: {} is {}",
                     is_open ? "nothing is decided" : "no method beats " + baseline_name(c),
                     shown_name(m),
                     names_text(c, {m.method}));
}

/// "ate rotation rmse", without the relation translation and the axis 3d.
std::string score_text(const Comparison& c, const std::string& value) {
  std::string out;
  const std::string relation = c.kind.relation == "translation" ? "" : c.kind.relation;
  const std::string axis = c.kind.axis == "3d" ? "" : c.kind.axis;
  for (const std::string& word : {c.kind.metric_label(), relation, axis, value}) {
    if (!word.empty()) out += (out.empty() ? "" : " ") + word;
  }
  return out + ", " + c.kind.times;
}

}  // namespace

std::string percent_text(double percent, int more) {
  const double size = std::abs(percent);
  if (size >= 9.95) return fmt::format("{:.{}f}", percent, more);
  return size >= 0.95 || size == 0.0 ? fmt::format("{:.{}f}", percent + 0.0, 1 + more)
                                     : fmt::format("{:.{}g}", percent, 2 + more);
}

std::string text(const Change& change, double narrow, int more) {
  const auto signed_text = [&](double percent) {
    return (percent > 0.0 ? "+" : "") + percent_text(percent, more);
  };
  if (change.high - change.low <= narrow) return signed_text(0.5 * (change.low + change.high));
  const auto [first, last] = ordered(change, change.low + change.high <= 0.0);
  return signed_text(first) + " to " + signed_text(last);
}

std::string result_text(const Comparison& c, const MethodVerdict& m) {
  const std::string out = names_text(c, {m.method});
  if (!m.p) return out;
  return out + (*m.p < 0.0001 ? ", p < 0.0001" : fmt::format(", p = {:.2g}", *m.p));
}

std::string title(const Comparison& c) {
  return score_text(c, c.options.value) + ", " + c.kind.protocol;
}

std::string short_title(const Comparison& c) {
  const std::string out = score_text(c, c.options.value == "rmse" ? "" : c.options.value);
  return c.kind.protocol == "loopbench" ? out : out + ", " + c.kind.protocol;
}

std::string sentence(const Comparison& c) {
  if (c.methods.empty()) return why_no_comparison(c);
  const auto is_equal = [](const MethodVerdict& m) {
    return m.ties > 0 && m.wins + m.losses + m.fails == 0;
  };
  if (std::ranges::all_of(c.methods, is_equal)) return "all methods are equal";
  if (!c.can_show) return too_few_text(c);
  const std::string covered = coverage_text(c, true);
  if (!c.is_best && !covered.empty()) return "no method is best: " + covered;
  const bool has_baseline = !c.find(c.options.baseline)->is_worse;
  if (has_baseline && !c.is_best) return shared_text(c);
  return best_text(
      c, names_where(c, [](const MethodVerdict& m) { return !m.is_worse; }), has_baseline);
}

}  // namespace loopbench::harness
