#include "tests/studies/error_rates.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace loopbench::synthetic {

namespace {

const MethodVerdict* verdict_of(const Comparison& c, std::size_t method) {
  const auto found =
      std::ranges::find(c.methods, "m" + std::to_string(method), &MethodVerdict::method);
  return found == c.methods.end() ? nullptr : &*found;
}

/// Order of the methods in truth: a method that fails mostly, then the effect, then divergence and
/// failures.
std::tuple<bool, double, double> burden(const Truth& truth, std::size_t method) {
  const double fails = truth.failures.empty() ? 0.0 : truth.failures[method];
  const bool is_last = method + 1 == truth.effects.size();
  return {fails > 0.5, truth.effects[method], fails + (is_last ? truth.diverges : 0.0)};
}

bool is_truly_best(const Truth& truth, std::size_t method) {
  for (std::size_t m = 0; m < truth.effects.size(); ++m) {
    if (burden(truth, m) < burden(truth, method)) return false;
  }
  return true;
}

std::size_t number_of(const std::string& method) {
  return static_cast<std::size_t>(std::stoi(method.substr(1)));
}

/// Whether a method is claimed to differ from the baseline in a direction that does not hold. Of
/// methods with equal effects, the one that fails less often is better.
bool has_false_claim(const Comparison& c, const Truth& truth) {
  const auto baseline = burden(truth, number_of(c.options.baseline));
  return std::ranges::any_of(c.methods, [&](const MethodVerdict& m) {
    const auto own = burden(truth, number_of(m.method));
    return (m.beats_baseline && own >= baseline) || (m.is_beaten && own <= baseline);
  });
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

/// Whether method 1 is ahead of each rival, with Holm's correction over the rivals.
bool beats_by_holm(const Observations& all) {
  GroupedValues values;
  for (const std::vector<Observed>& row : all.values) {
    values.values.emplace_back();
    for (const Observed& one : row) values.values.back().push_back(one.value);
  }
  for (std::size_t run = 0; run < all.runs.size(); ++run) values.group.push_back(run);
  const Levels levels(values, kTieShare);
  std::vector<double> p;
  for (std::size_t m = 0; m < levels.methods(); ++m) {
    if (m == 1) continue;
    const Pair pair = compared(levels, 1, m);
    p.push_back(pair.is_first_ahead() ? pair.p : 1.0);
  }
  std::ranges::sort(p);
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p[i] > 0.05 / static_cast<double>(p.size() - i)) return false;
  }
  return true;
}

bool is_plain(const Truth& t) {
  return t.runs_in_group == 1 && t.failures.empty() && t.copies == 0.0 && t.diverges == 0.0 &&
         t.hard == 0.0 && !t.is_independent && !t.baseline_is_fixed && t.dispersions.empty();
}

}  // namespace

ErrorRates error_rates(const Truth& truth, const Shape& shape, int repeats, std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  ErrorRates out;
  const bool is_fast = is_plain(truth);
  for (int i = 0; i < repeats; ++i) {
    std::vector<Observations> all;
    if (is_fast) {
      all.push_back(observations(truth, shape, bits));
    } else {
      all = harness::observations(records(truth, shape, bits), "rmse");
    }
    const bool is_power = is_fast && truth.effects[1] < 0.0;
    out.holm += is_power && beats_by_holm(all[0]) ? 1.0 : 0.0;
    const Comparison c = compare(std::move(all), {.baseline = "m0"}).at(0);
    bool is_false = false;
    std::size_t best = 0;
    for (const MethodVerdict& m : c.methods) {
      const bool is_true = is_truly_best(truth, number_of(m.method));
      is_false = is_false || (is_true && m.is_worse);
      best += is_true || !m.is_worse ? 1 : 0;
    }
    out.best += is_false ? 1.0 : 0.0;
    out.found += c.is_best && !is_false && best == 1 ? 1.0 : 0.0;
    out.baseline += has_false_claim(c, truth) ? 1.0 : 0.0;
    out.sequences += is_fast && !truth.sequences.empty() && has_false_clause(c, truth) ? 1.0 : 0.0;
  }
  for (double* rate : {&out.baseline, &out.best, &out.sequences, &out.found, &out.holm}) {
    *rate /= repeats;
  }
  return out;
}

IntervalCoverage coverage(const Truth& truth, const Shape& shape, int repeats, std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  const auto effect = [&](std::size_t m) {
    double sum = truth.effects[m];
    for (const std::vector<double>& of_sequence : truth.sequences) {
      sum += of_sequence[m] / static_cast<double>(truth.sequences.size());
    }
    return sum;
  };
  int given = 0;
  int held = 0;
  for (int i = 0; i < repeats; ++i) {
    const Comparison c = compare(records(truth, shape, bits), {.baseline = "m0"}).at(0);
    bool has_all = true;
    bool has_interval = true;
    for (std::size_t m = 1; m < truth.effects.size(); ++m) {
      const MethodVerdict* method = verdict_of(c, m);
      has_interval =
          has_interval && method != nullptr && method->ratio && method->ratio->has_interval;
      if (!has_interval) break;
      const double ratio = std::exp(effect(m) - effect(0));
      const Interval& found = method->ratio->typical;
      has_all = has_all && found.low <= ratio * (1.0 + 1e-9) && ratio <= found.high * (1.0 + 1e-9);
    }
    if (!has_interval) continue;
    ++given;
    held += has_all ? 1 : 0;
  }
  return {given > 0 ? static_cast<double>(held) / given : 1.0,
          1.0 - static_cast<double>(given) / repeats};
}

}  // namespace loopbench::synthetic
