#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "harness/base/counted.hpp"
#include "harness/compare/ratio_text.hpp"

namespace loopbench::harness {
namespace {

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

/// Difference of a method to the baseline: its ratio or, where none is defined, "better than raw on
/// 14 of 16 groups".
std::string distance(const MethodVerdict& m, const Comparison& c) {
  const std::size_t groups = m.wins + m.losses + m.ties;
  if (groups > 0 && m.ties == groups) return "equal to " + c.options.baseline;
  if (m.ratio) return ratio_text(*m.ratio, c.options.baseline, c);
  return fmt::format("{} than {} on {} of {} groups",
                     m.wins >= m.losses ? "better" : "worse",
                     c.options.baseline,
                     std::max(m.wins, m.losses),
                     groups);
}

/// "; fails: dual 2, raw 6 of 8 runs; declines: pcm 3": methods and their numbers of runs.
std::string missing_text(const Comparison& c) {
  const auto listed = [&](const char* what, std::size_t MethodVerdict::*count, std::size_t runs) {
    std::vector<std::string> named;
    for (const MethodVerdict& m : c.methods) {
      if (m.*count > 0) named.push_back(fmt::format("{} {}", m.method, m.*count));
    }
    if (named.empty()) return std::string();
    return fmt::format("; {}: {} of {} runs", what, joined_names(named), runs);
  };
  return listed("fails", &MethodVerdict::fails, c.runs) +
         listed("declines", &MethodVerdict::declines, c.possible);
}

std::string contradiction_text(const Comparison& c, const MethodVerdict& method) {
  if (!method.is_contradicted) return "";
  const bool has_mean = method.ratio && method.ratio->geometric_mean;
  return has_mean ? fmt::format(" on most {}, but the geometric mean ratio is {:.3f}",
                                c.groups < c.runs ? "groups" : "runs",
                                *method.ratio->geometric_mean)
                  : " on most runs, but not in the mean";
}

/// "; 5.2 % below dual, the next [2.0, 8.1]": the margin to the best method that is behind.
std::string next_text(const Comparison& c) {
  const MethodVerdict* next = nullptr;
  const auto margin = [](const MethodVerdict& m) {
    return std::abs(std::log(m.from_leader->typical.estimate));
  };
  for (const MethodVerdict& m : c.methods) {
    const bool is_behind = m.standing == Standing::behind && m.method != c.options.baseline;
    if (!is_behind || !m.from_leader) continue;
    if (next == nullptr || margin(m) < margin(*next)) next = &m;
  }
  if (next == nullptr || c.methods.size() == 2) return "";
  const std::string named =
      next->method + (c.is_best ? ", the next" : ", the next that is significantly worse");
  return "; " + ratio_text(*next->from_leader, named, c) + sequences_text(*next->from_leader, c);
}

/// "; on sparse, dm and gp are better": where the order of methods that are not significantly
/// different depends on the sequence.
std::string exceptions_text(const Comparison& c) {
  std::map<std::string, std::vector<std::string>> better;  // by sequence
  for (const MethodVerdict& m : c.methods) {
    if (m.standing != Standing::open || !m.from_leader) continue;
    for (const SequenceRatio& one : m.from_leader->by_sequence) {
      if (one.is_clear && is_gain(1.0 / one.ratio, c)) better[one.sequence].push_back(m.method);
    }
  }
  std::vector<std::string> parts;
  for (const auto& [sequence, methods] : better) {
    parts.push_back(fmt::format("on {} {} {} better than {}",
                                sequence,
                                joined_names(methods),
                                methods.size() == 1 ? "is" : "are",
                                c.methods.front().method));
  }
  return parts.empty() ? "" : "; the order depends on the sequence: " + joined_names(parts);
}

std::string why_no_comparison(const Comparison& c) {
  for (const Gap& gap : c.gaps) {
    if (!gap.is_ranked && gap.method == c.options.baseline) {
      return "the baseline " + gap.method + " has no value on any run: nothing is compared";
    }
  }
  if (c.runs == 0) return "no run has values of two methods: nothing is compared";
  return "one method alone has values: nothing is compared";
}

/// ": B is 12.3 % above A [8.1, 15.2], p = 0.004" if A is the baseline and B the only other method.
std::string only_other(const Comparison& c) {
  if (c.methods.size() != 2) return "";
  const bool is_first = c.methods.front().method != c.options.baseline;
  const MethodVerdict& other = is_first ? c.methods.front() : c.methods.back();
  return ": " + other.method + " is " + result_text(c, other);
}

/// "dual is ", or of several "dual and twin are equal, ".
std::string leaders_text(const Comparison& c) {
  const auto equal = names_where(c, [](const MethodVerdict& m) {
    return m.standing == Standing::leader || m.standing == Standing::equal;
  });
  return joined_names(equal) + (equal.size() == 1 ? " is " : " are equal, ");
}

std::string best_text(const Comparison& c, const std::vector<std::string>& leaders) {
  const MethodVerdict& baseline = *find(c, c.options.baseline);
  const std::size_t others = c.methods.size() - leaders.size();
  const std::string better = others == 0 ? ""
                             : others == 1
                                 ? "; significantly better than the other method"
                                 : "; significantly better than each of the other methods";
  const std::string tail = better + next_text(c);
  const std::string names = joined_names(leaders);
  if (leaders.size() == 1) {
    return baseline.standing == Standing::leader
               ? "the baseline " + names + " is best" + only_other(c) + tail
               : names + " is best: " + result_text(c, c.methods.front()) + tail;
  }
  const bool has_near = std::ranges::any_of(
      c.methods, [](const MethodVerdict& m) { return m.standing == Standing::near; });
  std::string out = names + " are best";
  out += has_near ? fmt::format(", within {:g} % of one another", 100.0 * c.options.relevant)
                  : " and equal";
  if (baseline.standing == Standing::leader || baseline.standing == Standing::equal) {
    return out + tail;
  }
  return out + ": " + (has_near ? leaders_text(c) : "") + result_text(c, c.methods.front()) + tail;
}

/// What holds although no method is best.
std::string undecided_text(const Comparison& c) {
  const MethodVerdict& first = c.methods.front();
  const auto open =
      names_where(c, [](const MethodVerdict& m) { return m.standing == Standing::open; });
  const auto winners = names_where(c, [](const MethodVerdict& m) { return m.beats_baseline; });
  const std::string rest = open.size() + 1 == c.methods.size() && open.size() > 1
                               ? "any other method"
                               : joined_names(open, " or ");
  const Standing baseline = find(c, c.options.baseline)->standing;
  if (baseline == Standing::leader || baseline == Standing::equal) {
    return "no method is significantly better than the baseline " + c.options.baseline +
           ", which is not significantly better than " + rest + only_other(c);
  }
  const std::string lead = leaders_text(c) + result_text(c, first);
  const std::string tail = exceptions_text(c) + next_text(c);
  if (first.beats_baseline) {
    return "no method is significantly best: " + lead + ", but not significantly better than " +
           rest + tail;
  }
  if (winners.empty()) {
    return "no method is significantly better than the baseline " + c.options.baseline + ": " +
           lead + exceptions_text(c);
  }
  return "no method is significantly best: significantly better than " + c.options.baseline +
         (winners.size() == 1 ? " is " : " are ") + joined_names(winners) + "; " + lead + tail;
}

}  // namespace

std::string result_text(const Comparison& c, const MethodVerdict& method) {
  std::string out = distance(method, c);
  if (method.ratio && method.standing == Standing::leader) out += sequences_text(*method.ratio, c);
  if (method.p) out += ", " + p_sentence(*method.p);
  return out + contradiction_text(c, method);
}

std::string cannot_show_text(const Comparison& c) {
  return fmt::format("{} cannot show a difference among {} methods at {:g} ({}{} are needed)",
                     unit_text(c),
                     c.methods.size(),
                     c.options.alpha,
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

std::vector<std::string> methods_with_less_coverage(const Comparison& c) {
  constexpr double kLess = 0.9;  // of the largest coverage
  return names_where(
      c, [&](const MethodVerdict& m) { return m.coverage < kLess * largest_coverage(c); });
}

std::vector<std::string> leaders_with_less_coverage(const Comparison& c) {
  std::vector<std::string> out = methods_with_less_coverage(c);
  std::erase_if(out, [&](const std::string& m) { return !is_leading(*find(c, m)); });
  return out;
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
  const auto leaders = names_where(c, is_leading);
  const std::string over = missing_text(c) + "; over " + unit_text(c);
  const auto is_equal = [](const MethodVerdict& m) {
    return m.standing == Standing::leader || m.standing == Standing::equal;
  };
  if (std::ranges::all_of(c.methods, is_equal)) return "all methods are equal" + over;
  const std::string covered = coverage_text(c, leaders_with_less_coverage(c));
  if (c.can_show && !covered.empty()) {
    return "no method is called best: " + covered + "; " + leaders_text(c) +
           result_text(c, c.methods.front()) + over;
  }
  if (c.can_show) return (c.is_best ? best_text(c, leaders) : undecided_text(c)) + over;
  const std::string lead =
      is_leading(*find(c, c.options.baseline))
          ? "the baseline " + c.options.baseline + " ranks first" + only_other(c)
          : leaders_text(c) + result_text(c, c.methods.front());
  return fmt::format("nothing can be shown: {}{}{}, but {}",
                     lead,
                     covered.empty() ? "" : ", and " + covered,
                     missing_text(c),
                     cannot_show_text(c));
}

std::string statement(const Comparison& c) {
  std::string out;
  for (const std::string& word : {c.kind.relation, c.kind.axis == "3d" ? "" : c.kind.axis}) {
    if (!word.empty()) out += word + " ";
  }
  const std::string unit = c.kind.unit.empty() ? "" : " [" + c.kind.unit + "]";
  return fmt::format("{}{}, {}{}, {}, {}: {}",
                     out,
                     c.kind.metric_label(),
                     c.options.value,
                     unit,
                     c.kind.times,
                     c.kind.protocol,
                     verdict(c));
}

}  // namespace loopbench::harness
