#include "tests/studies/error_rates.hpp"

#include <algorithm>
#include <cmath>

#include "harness/answers/tables/comparison.hpp"
#include "tests/studies/wilcoxon.hpp"
#include "tests/support/contradictions.hpp"

namespace loopbench::synthetic {

namespace {

/// Mean over the sequences.
double effect_of(const Truth& truth, std::size_t method) {
  double sum = truth.effects[method];
  for (const std::vector<double>& of_sequence : truth.sequences)
    sum += of_sequence[method] / static_cast<double>(truth.sequences.size());
  return std::abs(sum) < 1e-12 ? 0.0 : sum;
}

double failures_of(const Truth& truth, std::size_t method) {
  double out = truth.failures.empty() ? 0.0 : truth.failures[method];
  if (method + 1 == truth.effects.size()) out += truth.diverges;
  return out + (method == 1 ? truth.hard * truth.fails_hard : 0.0);
}

/// Whether no method has a smaller effect or fails less often.
bool is_truly_best(const Truth& truth, std::size_t method) {
  for (std::size_t m = 0; m < truth.effects.size(); ++m) {
    const bool is_better = effect_of(truth, m) < effect_of(truth, method) - 1e-9 ||
                           failures_of(truth, m) < failures_of(truth, method);
    if (is_better) return false;
  }
  return true;
}

std::size_t number_of(const std::string& method) {
  return static_cast<std::size_t>(std::stoi(method.substr(1)));
}

/// Whether a method is said to fail more often than the baseline and does not.
bool has_false_failures(const Comparison& c, const Truth& truth) {
  const double baseline = failures_of(truth, number_of(c.options.baseline));
  return std::ranges::any_of(c.methods, [&](const MethodVerdict& m) {
    return m.fails_more && failures_of(truth, number_of(m.method)) <= baseline;
  });
}

/// Whether a method is claimed to differ from the baseline in a direction that does not hold.
bool has_false_claim(const Comparison& c, const Truth& truth) {
  const double baseline = effect_of(truth, number_of(c.options.baseline));
  return std::ranges::any_of(c.methods, [&](const MethodVerdict& m) {
    const double own = effect_of(truth, number_of(m.method));
    return (m.beats_baseline && own >= baseline) || (m.is_beaten && own <= baseline);
  });
}

/// Whether an interval does not hold the ratio of the methods.
bool has_missed(const Comparison& c, const Truth& truth) {
  return std::ranges::any_of(c.methods, [&](const MethodVerdict& m) {
    if (!m.ratio || !m.ratio->has_interval || m.method == c.options.baseline) return false;
    const double ratio = std::exp(effect_of(truth, number_of(m.method)) - effect_of(truth, 0));
    const Interval& found = m.ratio->typical;
    return found.low > ratio * (1.0 + 1e-9) || ratio > found.high * (1.0 + 1e-9);
  });
}

bool has_intervals(const Comparison& c) {
  return std::ranges::all_of(c.methods, [&](const MethodVerdict& m) {
    return m.method == c.options.baseline || (m.ratio && m.ratio->has_interval);
  });
}

bool is_contradictory(const Comparison& c) {
  const auto all = nlohmann::json::parse(json({c}));
  return !contradictions(all.at(0)).empty();
}

bool has_false_clause(const Comparison& c, const Truth& truth) {
  return std::ranges::any_of(c.methods, [&](const MethodVerdict& m) {
    if (!m.ratio) return false;
    const std::size_t own = number_of(m.method);
    return std::ranges::any_of(m.ratio->by_sequence, [&](const SequenceRatio& one) {
      const std::vector<double>& effects = truth.sequences[number_of("m" + one.sequence)];
      const double effect = truth.effects[own] - truth.effects[0] + effects[own] - effects[0];
      return one.is_clear && (one.ratio < 1.0 ? effect >= 0.0 : effect <= 0.0);
    });
  });
}

/// Log ratios of method 1 to another one, on all runs.
std::vector<double> log_ratios(const Observations& all, std::size_t method) {
  std::vector<double> out;
  for (std::size_t run = 0; run < all.runs.size(); ++run)
    out.push_back(std::log(*all.values[1][run].value / *all.values[method][run].value));
  return out;
}

/// Whether method 1 is ahead of each rival by Wilcoxon's test, with Holm's correction over the
/// rivals.
bool beats_by_holm(const Observations& all) {
  std::vector<double> p;
  for (std::size_t m = 0; m < all.values.size(); ++m) {
    if (m == 1) continue;
    const std::vector<double> differences = log_ratios(all, m);
    const auto wins = std::ranges::count_if(differences, [](double d) { return d < 0.0; });
    p.push_back(2 * wins > std::ssize(differences) ? wilcoxon_p(differences) : 1.0);
  }
  std::ranges::sort(p);
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p[i] > 0.05 / static_cast<double>(p.size() - i)) return false;
  }
  return true;
}

bool is_plain(const Truth& t) {
  return t.runs_in_group == 1 && t.copies == 0.0 && t.diverges == 0.0 && t.hard == 0.0 &&
         !t.is_independent;
}

/// Its time grows with the cube of the runs.
constexpr std::size_t kMostForWilcoxon = 20;

}  // namespace

ErrorRates error_rates(const Truth& truth, const Shape& shape, int repeats, std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  ErrorRates out;
  const bool is_fast = is_plain(truth);
  int with_intervals = 0;
  for (int i = 0; i < repeats; ++i) {
    std::vector<Observations> all;
    if (is_fast) {
      all.push_back(observations(truth, shape, bits));
    } else {
      all = harness::observations(records(truth, shape, bits), "rmse");
    }
    const bool is_power = is_fast && truth.effects[1] < 0.0 && truth.failures.empty();
    out.holm += is_power && beats_by_holm(all[0]) ? 1.0 : 0.0;
    const bool is_two = is_fast && truth.effects.size() == 2 && truth.failures.empty() &&
                        truth.groups <= kMostForWilcoxon;
    out.wilcoxon += is_two && wilcoxon_p(log_ratios(all[0], 0)) <= 0.05 ? 1.0 : 0.0;
    const Comparison c = compare(std::move(all), {.baseline = "m0"}).at(0);
    bool is_false = false;
    std::size_t best = 0;
    for (const MethodVerdict& m : c.methods) {
      const bool is_true = is_truly_best(truth, number_of(m.method));
      is_false = is_false || (is_true && m.is_worse);
      best += is_true || !m.is_worse ? 1 : 0;
      out.claimed += m.method == "m1" && m.beats_baseline ? 1.0 : 0.0;
    }
    out.best += is_false ? 1.0 : 0.0;
    out.found += c.is_best && !is_false && best == 1 ? 1.0 : 0.0;
    out.baseline += has_false_claim(c, truth) ? 1.0 : 0.0;
    out.failures += has_false_failures(c, truth) ? 1.0 : 0.0;
    out.sequences += is_fast && !truth.sequences.empty() && has_false_clause(c, truth) ? 1.0 : 0.0;
    out.contradicted += is_contradictory(c) ? 1.0 : 0.0;
    if (!has_intervals(c)) continue;
    ++with_intervals;
    out.intervals += 1.0;
    out.missed += has_missed(c, truth) ? 1.0 : 0.0;
  }
  out.missed *= static_cast<double>(repeats) / std::max(1, with_intervals);
  for (double* rate : {&out.baseline,
                       &out.best,
                       &out.sequences,
                       &out.failures,
                       &out.missed,
                       &out.intervals,
                       &out.contradicted,
                       &out.claimed,
                       &out.found,
                       &out.holm,
                       &out.wilcoxon}) {
    *rate /= repeats;
  }
  return out;
}

IntervalCoverage coverage(const Truth& truth, const Shape& shape, int repeats, std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  int given = 0;
  int held = 0;
  for (int i = 0; i < repeats; ++i) {
    const Comparison c = compare(records(truth, shape, bits), {.baseline = "m0"}).at(0);
    if (!has_intervals(c)) continue;
    ++given;
    held += has_missed(c, truth) ? 0 : 1;
  }
  return {given > 0 ? static_cast<double>(held) / given : 1.0,
          1.0 - static_cast<double>(given) / repeats};
}

}  // namespace loopbench::synthetic
