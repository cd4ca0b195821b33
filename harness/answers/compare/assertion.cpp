#include "harness/answers/compare/assertion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "datasets/core/error.hpp"
#include "harness/answers/compare/verdict.hpp"
#include "harness/sweep/text/pattern.hpp"
#include "harness/sweep/text/suggest.hpp"

namespace loopbench::harness {
namespace {

struct Assertion {
  enum class Relation { below, not_above, not_different };

  std::string method;
  Relation relation = Relation::below;
  std::optional<double> percent;
  std::string baseline;
};

/// Names of the methods of a comparison, also of those without a value.
std::vector<std::string> method_names(const Comparison& c) {
  std::vector<std::string> out;
  for (const MethodVerdict& m : c.methods) out.push_back(m.method);
  for (const Gap& gap : c.gaps) {
    if (!gap.is_ranked) out.push_back(gap.method);
  }
  return out;
}

bool is_shown(const Assertion& a, const Comparison& c, const MethodVerdict& m) {
  const bool is_inverse = c.kind.better == metrics::Better::higher;
  const bool is_better = m.p && m.beats_baseline;
  const bool is_worse = m.p && m.is_beaten;
  const bool is_lower = is_inverse ? is_worse : is_better;
  const bool is_higher = is_inverse ? is_better : is_worse;
  const auto is_up_to = [&](double limit) {
    return m.ratio && m.ratio->has_interval && m.ratio->typical.high <= limit;
  };
  switch (a.relation) {
    case Assertion::Relation::below:
      return is_lower && (!a.percent || is_up_to(1.0 - *a.percent / 100.0));
    case Assertion::Relation::not_above:
      return a.percent ? is_up_to(1.0 + *a.percent / 100.0) : !is_higher;
    case Assertion::Relation::not_different:
      break;
  }
  return !is_lower && !is_higher;
}

/// Names can contain " is ": the first form counts.
Assertion parse_assertion(const std::string& text) {
  static const Pattern kForms(
      R"((.+?) is (below|not above|not shown to differ from|at least (\d*\.?\d+) % below|)"
      R"(at most (\d*\.?\d+) % above) (.+))");
  const auto found = kForms.groups(text);
  if (!found) {
    throw InputError(
        "--assert: expected 'A is below B', 'A is at least X % below B', 'A is not above B', "
        "'A is at most X % above B' or 'A is not shown to differ from B', found '" +
        text + "'");
  }
  const std::vector<std::string>& groups = *found;
  const std::string& words = groups[1];
  const std::string percent = groups[2] + groups[3];
  Assertion out{.method = groups[0], .percent = {}, .baseline = groups[4]};
  if (!words.ends_with("below")) {
    out.relation = words.ends_with("above") ? Assertion::Relation::not_above
                                            : Assertion::Relation::not_different;
  }
  if (!percent.empty()) out.percent = std::strtod(percent.c_str(), nullptr);
  return out;
}

/// Why the comparison, with the baseline of the assertion, does not show it; empty if it does.
std::string why_not_shown(const Assertion& a, const Comparison& c) {
  const bool is_order = a.relation != Assertion::Relation::not_different;
  if (is_order && c.kind.better == metrics::Better::target) {
    throw InputError(
        fmt::format("the best value of {} is {:g}, so that neither above nor below is better; "
                    "expected 'A is not shown to differ from B'",
                    c.kind.metric_label(),
                    c.kind.target));
  }
  if (c.methods.empty()) return sentence(c);
  const MethodVerdict* const m = c.find(a.method);
  if (m == nullptr) return a.method + " has no value on any run";
  if (m->wins + m->losses + m->ties == 0) return "the methods have no run in common";
  if (is_order && m->covers_less) return coverage_text(c, false);
  if (is_shown(a, c, *m)) return "";
  std::string out = "measured " + result_text(c, *m) + "; ";
  out += m->p ? "over " + unit_text(c) : cannot_show_text(c);
  if (c.kind.better == metrics::Better::higher) {
    out += "; above and below compare values, of which higher ones are better";
  }
  return out;
}

}  // namespace

std::vector<std::string> not_shown(const std::vector<std::string>& sentences,
                                   const Comparison& printed,
                                   const CompareWith& compare_with) {
  std::vector<std::string> out;
  const std::vector<std::string> known = method_names(printed);
  for (const std::string& text : sentences) {
    const Assertion a = parse_assertion(text);
    try {
      for (const std::string& method : {a.method, a.baseline}) {
        if (printed.methods.empty() || std::ranges::count(known, method) > 0) continue;
        throw InputError(unknown_name("method", method, known));
      }
      const bool is_printed = printed.options.baseline == a.baseline;
      const std::string why = why_not_shown(a, is_printed ? printed : compare_with(a.baseline));
      if (!why.empty()) out.push_back(fmt::format("assertion not shown: {}: {}", text, why));
    } catch (const InputError& error) {
      throw InputError(fmt::format("--assert: '{}': {}", text, error.what()));
    }
  }
  return out;
}

}  // namespace loopbench::harness
