#include <fmt/format.h>

#include <algorithm>

#include "harness/compare/compare.hpp"

namespace loopbench {
namespace {

std::string joined_names(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    out += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
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

/// "12.3 % below raw [8.1, 15.2]": how far a method is from the baseline.
std::string distance(const MethodVerdict& method, const CompareOptions& options) {
  if (!method.ratio) return "against " + options.baseline;
  const double sign = method.ratio->estimate <= 1.0 ? -100.0 : 100.0;
  const auto percent = [&](double ratio) { return sign * (ratio - 1.0); };
  std::string out = fmt::format("{:.1f} % {} {}",
                                percent(method.ratio->estimate),
                                sign < 0.0 ? "below" : "above",
                                options.baseline);
  if (method.has_interval) {
    const double low = percent(method.ratio->low);
    const double high = percent(method.ratio->high);
    out += fmt::format(" [{:.1f}, {:.1f}]", std::min(low, high), std::max(low, high));
  }
  return out;
}

std::string why_nothing(const Comparison& c) {
  if (c.observations == 0) return "no run has a value of every method: nothing is compared";
  for (const Gap& gap : c.gaps) {
    if (!gap.is_ranked && gap.method == c.options.baseline) {
      return "the baseline " + gap.method + " has no value on any run: nothing is compared";
    }
  }
  return "one method alone has values: nothing is compared";
}

/// Who shares the first place, and who cannot be told from it. The baseline is left out where the
/// test against it, which was not picked by looking, has told it apart already.
std::string company(const Comparison& c) {
  std::vector<std::string> equal;
  std::vector<std::string> like;
  std::vector<std::string> others;
  for (std::size_t m = 1; m < c.methods.size(); ++m) {
    const MethodVerdict& method = c.methods[m];
    if (method.equals_best) {
      equal.push_back(method.method);
    } else if (method.method != c.options.baseline || c.methods[0].p >= c.options.alpha) {
      others.push_back(method.method);
      if (method.p_best >= c.options.alpha) like.push_back(method.method);
    }
  }
  std::string out = equal.empty() ? "" : "; the same on every run: " + joined_names(equal);
  if (others.empty()) return out;
  if (like.empty()) return out + "; different from all others";
  if (like.size() == others.size()) return out + "; no other method is proven different from it";
  return out + "; not proven different from " + joined_names(like);
}

}  // namespace

std::string verdict(const Comparison& c) {
  if (c.methods.empty()) return why_nothing(c);
  const MethodVerdict& best = c.methods[0];
  const MethodVerdict* baseline = find(c, c.options.baseline);
  if (&best == baseline || baseline->equals_best) {
    return fmt::format(
        "nothing ranks better than the baseline {}{}", c.options.baseline, company(c));
  }
  std::string out = best.method + " ranks best: " + distance(best, c.options) + ", ";
  if (c.least_p_holm >= c.options.alpha) {
    out += fmt::format(
        "which {} cannot prove against {} methods (least p {:.2g})",
        c.observations == 1 ? "one observation" : fmt::format("{} observations", c.observations),
        c.methods.size() - 1,
        c.least_p_holm);
  } else {
    out += p_sentence(best.p) + (best.p < c.options.alpha ? "" : ", not significant");
  }
  return out + company(c);
}

std::vector<std::string> remarks(const Comparison& c) {
  std::vector<std::string> out;
  const bool by_run = c.options.over == Over::runs;
  const std::string what = (by_run ? "run" : "sequence") + std::string(c.possible == 1 ? "" : "s");
  if (c.observations < c.possible) {
    out.push_back(fmt::format("over {} of {} {}, those on which every method has a value",
                              c.observations,
                              c.possible,
                              what));
  } else {
    out.push_back(fmt::format("over {} {}", c.observations, what));
  }
  if (by_run && c.sequences < c.observations) {
    out.back() += fmt::format(
        " of {} sequence{}: holds for these, with other noise; --over sequences asks for others",
        c.sequences,
        c.sequences == 1 ? "" : "s");
  }
  for (const Gap& gap : c.gaps) {
    out.push_back(
        gap.is_ranked
            ? fmt::format(
                  "{} lacks {} of {} {}: {}", gap.method, gap.missing, c.possible, what, gap.why)
            : fmt::format("{} is not ranked, it has no value: {}", gap.method, gap.why));
  }
  if (!c.oracles.empty()) {
    out.push_back("not ranked, shown the reference: " + joined_names(c.oracles));
  }
  if (c.methods.empty()) return out;
  out.push_back(fmt::format(
      "ratio: geometric mean of value / {}, {:g} % {} interval; p: Wilcoxon signed-rank "
      "(Pratt), Holm over {} methods; effect: rank-biserial, positive is better",
      c.options.baseline,
      100.0 * (1.0 - c.options.alpha),
      c.longest_block > 0 ? "block bootstrap" : "BCa bootstrap",
      c.methods.size() - 1));
  if (c.longest_block > 0) {
    out.push_back(fmt::format(
        "intervals resample blocks of up to {} poses along each run: how much of a ratio is the "
        "luck of a stretch, not what other runs would show",
        c.longest_block));
  }
  out.push_back(fmt::format(
      "ranks: Friedman {}; groups share a letter when ranks lie within Nemenyi's critical "
      "difference {:.2f}",
      p_sentence(c.friedman_p),
      c.critical_difference));
  if (c.least_p_holm >= c.options.alpha) {
    out.push_back(fmt::format(
        "too few {} to prove anything: {} can reach p = {:.2g}, after Holm {:.2g}, at {} tested",
        what,
        c.observations,
        c.least_p,
        c.least_p_holm,
        c.options.alpha));
  }
  const bool has_ratio = std::ranges::all_of(
      c.methods, [](const MethodVerdict& method) { return method.ratio.has_value(); });
  if (!has_ratio) {
    out.push_back("some values are not positive: no ratio there, p from plain differences");
  } else if (c.observations < kFewestForInterval && c.longest_block == 0) {
    out.push_back(fmt::format("no interval from fewer than {} {}", kFewestForInterval, what));
  }
  return out;
}

}  // namespace loopbench
