#include "tests/studies/error_rates.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace loopbench::synthetic {

using namespace methods;
using namespace metrics;
using namespace harness;

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

/// The only method with the least burden; the number of methods if several share it.
std::size_t truly_best(const Truth& truth) {
  std::size_t best = 0;
  bool is_shared = false;
  for (std::size_t m = 1; m < truth.effects.size(); ++m) {
    is_shared = burden(truth, m) == burden(truth, best) ||
                (is_shared && burden(truth, m) > burden(truth, best));
    if (burden(truth, m) < burden(truth, best)) best = m;
  }
  return is_shared ? truth.effects.size() : best;
}

/// Whether a method is claimed to differ from the baseline in a direction that does not hold. Of
/// methods with equal effects, the one that fails less often is better.
bool has_false_claim(const Comparison& c, const Truth& truth) {
  const auto error = [&](const std::string& method) {
    return burden(truth, static_cast<std::size_t>(std::stoi(method.substr(1))));
  };
  const auto baseline = error(c.options.baseline);
  return std::ranges::any_of(c.methods, [&](const MethodVerdict& m) {
    const bool is_worse = m.p && *m.p <= c.options.alpha && !m.is_contradicted && !m.beats_baseline;
    return (m.beats_baseline && error(m.method) >= baseline) ||
           (is_worse && error(m.method) <= baseline);
  });
}

}  // namespace

ErrorRates error_rates(const Truth& truth, const Shape& shape, int repeats, std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  ErrorRates out;
  const std::size_t best = truly_best(truth);
  for (int i = 0; i < repeats; ++i) {
    const Comparison c = compare(records(truth, shape, bits), {.baseline = "m0"}).at(0);
    const bool is_right = c.is_best && c.methods[0].method == "m" + std::to_string(best);
    out.found += is_right ? 1.0 : 0.0;
    out.false_best += c.is_best && !is_right ? 1.0 : 0.0;
    out.false_better += has_false_claim(c, truth) ? 1.0 : 0.0;
  }
  for (double* rate : {&out.found, &out.false_best, &out.false_better}) {
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

double power(const Truth& truth, const Shape& shape, int repeats, std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  int found = 0;
  for (int i = 0; i < repeats; ++i) {
    const Comparison c = compare(records(truth, shape, bits), {.baseline = "m0"}).at(0);
    found += verdict_of(c, 1)->beats_baseline ? 1 : 0;
  }
  return static_cast<double>(found) / repeats;
}

}  // namespace loopbench::synthetic
