#include "harness/compare/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace loopbench::harness {
namespace {

using Names = std::vector<std::string>;

const MethodVerdict& find(const Comparison& c, const std::string& method) {
  return *std::ranges::find(c.methods, method, &MethodVerdict::method);
}

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

/// "below raw", for a score with a target "closer to 1 than raw".
std::string relation_text(const Comparison& c, bool is_below) {
  if (c.kind.better != metrics::Better::target) {
    return (is_below ? "below " : "above ") + c.options.baseline;
  }
  return fmt::format("{} {:g} than {}",
                     is_below ? "closer to" : "farther from",
                     c.kind.target,
                     c.options.baseline);
}

/// What an observation is.
const char* observed_unit(const Comparison& c) {
  if (c.groups == c.runs) return "runs";
  return c.options.over == Over::sequences ? "sequences" : "groups";
}

/// Why the difference of a method to the baseline is no number.
std::string without_number(const Comparison& c, const MethodVerdict& m) {
  if (m.is_divided)
    return "better or worse than " + c.options.baseline + ": it depends on the sequence";
  const bool is_ahead = m.wins >= m.losses;
  if (m.is_contradicted) {
    return fmt::format("{} {} on most runs, but not in the mean",
                       is_ahead ? "ahead of" : "behind",
                       c.options.baseline);
  }
  return fmt::format("{} than {} on {} of {} {}",
                     is_ahead ? "better" : "worse",
                     c.options.baseline,
                     std::max(m.wins, m.losses),
                     m.wins + m.losses + m.ties,
                     c.has_strata ? "pairs of runs" : observed_unit(c));
}

/// "37 to 44 % below raw (95 %: 30 to 51)".
std::string change_text(const Comparison& c,
                        const Change& change,
                        const std::optional<Change>& interval) {
  const bool is_below = change.low + change.high <= 0.0;
  const double sign = is_below ? -1.0 : 1.0;
  const auto range = [&](const Change& of) {
    const auto [least, most] = std::minmax({sign * of.low, sign * of.high});
    return percent_text(least) + " to " + percent_text(most);
  };
  std::string out = change.high - change.low > 1.0
                        ? range(change)
                        : percent_text(0.5 * sign * (change.low + change.high));
  out += " % " + relation_text(c, is_below);
  if (!interval) return out;
  return out + fmt::format(" ({:g} %: {})", 100.0 * (1.0 - c.options.alpha), range(*interval));
}

std::string names_text(const Comparison& c, const Names& methods) {
  std::vector<const MethodVerdict*> members;
  for (const MethodVerdict& m : c.methods) {
    if (std::ranges::count(methods, m.method) > 0) members.push_back(&m);
  }
  const VerdictGroup group = group_of(members, {}, c.options.baseline);
  return group.all ? change_text(c, *group.all, group.interval)
                   : without_number(c, *members.front());
}

/// How many observations would decide the difference of a method that has an interval.
std::string needed_text(const Comparison& c, const MethodVerdict& m) {
  if (!m.ratio || !m.ratio->has_interval || m.p.value_or(0.0) <= c.options.alpha) return "";
  const Interval& typical = m.ratio->typical;
  const double distance = std::abs(std::log(typical.estimate));
  if (distance < std::log1p(c.options.relevant)) return "";
  const double side = std::log(typical.estimate < 1.0 ? typical.high : typical.low);
  const double width = std::abs(side - std::log(typical.estimate));
  const auto now = static_cast<double>(c.groups);
  const double needed = std::max(now + 1.0, std::ceil(now * std::pow(width / distance, 2)));
  return fmt::format("; about {:.0f} {} would decide (now {})", needed, observed_unit(c), c.groups);
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

/// "open 0.064 m, other 0.121 m (+91 %). One recording; a test needs 6".
std::string too_few_text(const Comparison& c) {
  constexpr std::size_t kMost = 3;
  if (c.groups > 1) {
    const MethodVerdict& m = first_other(c);
    return m.method + " is " + names_text(c, {m.method}) + ". " + cannot_show_text(c);
  }
  const auto value = [&](const MethodVerdict& m) {
    const std::string unit = (c.kind.unit.empty() ? "" : " ") + c.kind.unit;
    return m.method + (m.runs == 0 ? " failed" : fmt::format(" {:.3g}{}", m.median, unit));
  };
  std::string out = value(find(c, c.options.baseline));
  std::size_t shown = 1;
  for (const MethodVerdict& m : c.methods) {
    if (m.method == c.options.baseline) continue;
    if (++shown > kMost) continue;
    out += ", " + value(m);
    if (!m.ratio) continue;
    const double percent = 100.0 * (m.ratio->typical.estimate - 1.0);
    out += fmt::format(" ({}{} %)", percent < 0.0 ? "-" : "+", percent_text(std::abs(percent)));
  }
  if (shown > kMost) out += fmt::format(", {} more", shown - kMost);
  return out + ". " + cannot_show_text(c);
}

std::string best_text(const Comparison& c, const Names& first, bool has_baseline) {
  const std::string name = common_name(c, first);
  const bool is_one = first.size() == 1 || name.ends_with(" with a smoother");
  const char* const place = is_one      ? " is best"
                            : c.is_best ? " are best"
                                        : " share the first place";
  if (!has_baseline) {
    Names divided;
    for (const std::string& each : first) {
      if (first.size() > 1 && find(c, each).is_divided) divided.push_back(each);
    }
    const std::string changes = name + place + ", " + names_text(c, first);
    if (divided.empty()) return changes;
    return changes + "; " + short_names(divided, " and ") + " depends on the sequence";
  }
  if (first.size() > 1) return name + place;
  const MethodVerdict& next = first_other(c);
  return "the baseline " + name + " is best: " + next.method + " is " +
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
  const bool is_open = std::ranges::none_of(c.methods, &MethodVerdict::is_worse);
  return fmt::format("{}: {} is {}{}",
                     is_open ? "nothing is decided" : "no method beats " + c.options.baseline,
                     m.method,
                     names_text(c, {m.method}),
                     needed_text(c, m));
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

/// Without what is usual: "ate rotation, dense".
std::string short_title(const Comparison& c) {
  const std::string out = score_text(c, c.options.value == "rmse" ? "" : c.options.value);
  return c.kind.protocol == "loopbench" ? out : out + ", " + c.kind.protocol;
}

std::string legend_of(const Comparison& c, const Verdict& v) {
  const MethodVerdict& m = first_other(c);
  const std::string value = c.kind.better == metrics::Better::target
                                ? fmt::format("|value - {:g}|", c.kind.target)
                                : "change";
  std::string out = v.has_table() ? "all: " : "";
  out += (m.ratio && m.ratio->is_of_sequences ? "mean over the sequences of their typical "
                                              : "typical ") +
         value + " to " + c.options.baseline + " over " + unit_text(c);
  if (c.groups < c.runs) out += " of dependent runs";
  out += ", for all methods together";
  if (v.groups.size() > 1) out += "; =: shares the first place, >: significantly worse";
  if (c.has_strata) {
    out += "; runs of a sequence are independent (rank sums; --paired pairs equal names)";
  } else if (c.sequences < c.groups) {
    out += "; other sequences need --over sequences, 6 or more";
  }
  return out;
}

}  // namespace

std::string percent_text(double percent) {
  if (std::abs(percent) >= 9.95) return fmt::format("{:.0f}", percent);
  return std::abs(percent) >= 0.95 || percent == 0.0 ? fmt::format("{:.1f}", percent + 0.0)
                                                     : fmt::format("{:.2g}", percent);
}

std::string result_text(const Comparison& c, const MethodVerdict& m) {
  std::string out = names_text(c, {m.method});
  if (m.ratio && !m.is_divided && !m.is_contradicted) {
    const Interval& typical = m.ratio->typical;
    const double sign = typical.estimate <= 1.0 ? -100.0 : 100.0;
    out = fmt::format("{:.1f} % {}", sign * (typical.estimate - 1.0), relation_text(c, sign < 0.0));
    const auto [low, high] = std::minmax({sign * (typical.low - 1.0), sign * (typical.high - 1.0)});
    if (m.ratio->has_interval) out += fmt::format(" [{:.1f}, {:.1f}]", low, high);
  }
  if (m.p) out += *m.p < 0.0001 ? ", p < 0.0001" : fmt::format(", p = {:.2g}", *m.p);
  return out;
}

std::string title(const Comparison& c) {
  return score_text(c, c.options.value) + ", " + c.kind.protocol;
}

std::string sentence(const Comparison& c) {
  if (c.methods.empty()) return why_no_comparison(c);
  const auto is_equal = [](const MethodVerdict& m) { return m.ties > 0 && m.wins + m.losses == 0; };
  if (std::ranges::all_of(c.methods, is_equal)) return "all methods are equal";
  if (!c.can_show) return too_few_text(c);
  const std::string covered = coverage_text(c, leaders_with_less_coverage(c));
  if (!c.is_best && !covered.empty()) return "no method is best: " + covered;
  const bool has_baseline = !find(c, c.options.baseline).is_worse;
  if (has_baseline && !c.is_best) return shared_text(c);
  return best_text(
      c, names_where(c, [](const MethodVerdict& m) { return !m.is_worse; }), has_baseline);
}

Verdict verdict_of(const Comparison& c, const std::vector<Comparison>& all) {
  constexpr std::size_t kMostSequences = 6;
  Verdict out;
  out.sentence = short_title(c) + ": " + sentence(c) + ".";
  if (c.methods.empty()) return out;
  for (const MethodVerdict& m : c.methods) {
    if (!m.ratio || m.method == c.options.baseline) continue;
    for (const SequenceRatio& one : m.ratio->by_sequence) {
      if (std::ranges::count(out.sequences, one.sequence) == 0)
        out.sequences.push_back(one.sequence);
    }
  }
  if (out.sequences.size() > kMostSequences) out.sequences.clear();
  out.cautions = cautions_of(c, all);
  if (!c.can_show) {
    out.sequences.clear();
    return out;
  }
  out.groups = groups_of(c, out.sequences);
  out.level = 100.0 * (1.0 - c.options.alpha);
  out.legend = legend_of(c, out);
  return out;
}

}  // namespace loopbench::harness
