/// Measures the coverage of mean_interval's 95 % intervals by distribution and number of values: of
/// all intervals, with their width, and of those that two stricter rules would keep. Prints
/// Markdown (results/methods/intervals.md). Usage: interval_coverage [samples].
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "harness/statistics/average.hpp"
#include "harness/statistics/mean_interval.hpp"
#include "harness/statistics/student.hpp"

namespace loopbench::interval_coverage {
namespace {

using Sample = std::vector<double>;

/// Random numbers that do not depend on the standard library.
class Draws {
 public:
  double uniform() { return (static_cast<double>(bits_() >> 11) + 0.5) * 0x1p-53; }
  double exponential() { return -std::log(uniform()); }
  double normal() { return std::sqrt(2.0 * exponential()) * std::cos(2.0 * M_PI * uniform()); }

 private:
  std::mt19937_64 bits_{11};
};

struct Distribution {
  const char* name;
  double mean;
  double (*draw)(Draws&);
};

const Distribution kDistributions[] = {
    {"normal", 0.0, [](Draws& d) { return d.normal(); }},
    {"uniform", 0.5, [](Draws& d) { return d.uniform(); }},
    {"Laplace", 0.0, [](Draws& d) { return d.exponential() - d.exponential(); }},
    {"t, 3 degrees of freedom",
     0.0,
     [](Draws& d) {
       const double a = d.normal(), b = d.normal(), c = d.normal();
       return d.normal() / std::sqrt((a * a + b * b + c * c) / 3.0);
     }},
    {"lognormal 0.5", std::exp(0.125), [](Draws& d) { return std::exp(0.5 * d.normal()); }},
    {"exponential", 1.0, [](Draws& d) { return d.exponential(); }},
    {"lognormal 1", std::exp(0.5), [](Draws& d) { return std::exp(d.normal()); }},
    {"lognormal 0.75", std::exp(0.28125), [](Draws& d) { return std::exp(0.75 * d.normal()); }},
    {"Weibull 0.7",
     std::tgamma(1.0 + 1.0 / 0.7),
     [](Draws& d) { return std::pow(d.exponential(), 1.0 / 0.7); }},
    {"normal, one in ten 5 times as wide",
     0.0,
     [](Draws& d) { return (d.uniform() < 0.1 ? 5.0 : 1.0) * d.normal(); }},
    {"half 0, half normal", 0.0, [](Draws& d) { return d.uniform() < 0.5 ? 0.0 : d.normal(); }},
    {"3/4 0, 1/4 normal", 0.0, [](Draws& d) { return d.uniform() < 0.75 ? 0.0 : d.normal(); }},
    {"half 0, half normal + 1",
     0.5,
     [](Draws& d) { return d.uniform() < 0.5 ? 0.0 : d.normal() + 1.0; }},
    {"half 0, half exponential",
     0.5,
     [](Draws& d) { return d.uniform() < 0.5 ? 0.0 : d.exponential(); }},
    {"3/4 0, 1/4 exponential",
     0.25,
     [](Draws& d) { return d.uniform() < 0.75 ? 0.0 : d.exponential(); }},
};

/// At most half of the values are 0.
bool has_few_ties(const Sample& x) {
  return 2 * std::ranges::count(x, 0.0) <= static_cast<std::ptrdiff_t>(x.size());
}

/// The sample skewness is at most 1.5.
bool has_low_skewness(const Sample& x) {
  const auto n = static_cast<double>(x.size());
  const double mean = harness::mean(x);
  const double deviation = harness::sample_deviation(x);
  double cubes = 0.0;
  for (const double value : x) cubes += std::pow(value - mean, 3);
  return std::abs(n / ((n - 1.0) * (n - 2.0)) * cubes) <= 1.5 * std::pow(deviation, 3);
}

struct Counts {
  int given = 0;
  int covers = 0;

  std::string text(int samples) const {
    return given == 0
               ? "- | 0"
               : fmt::format("{:.1f} | {:.0f}", 100.0 * covers / given, 100.0 * given / samples);
  }
};

void print_row(const Distribution& from, std::size_t n, int samples, Draws& draws) {
  Counts all, few_ties, low_skewness;
  double width = 0.0;  // sum of the ratios to Student's
  const double student = 2.0 * harness::student_quantile(0.05, n - 1) / std::sqrt(double(n));
  Sample x(n);
  for (int i = 0; i < samples; ++i) {
    for (double& value : x) value = from.draw(draws);
    const auto found = harness::mean_interval(x);
    if (!found) continue;
    const bool covers = found->interval.low <= from.mean && from.mean <= found->interval.high;
    const auto add = [&](Counts& to) {
      ++to.given;
      to.covers += covers ? 1 : 0;
    };
    add(all);
    width +=
        (found->interval.high - found->interval.low) / (student * harness::sample_deviation(x));
    if (has_few_ties(x)) add(few_ties);
    if (has_low_skewness(x)) add(low_skewness);
  }
  fmt::print("| {} | {} | {} | {} | {} | {} |\n",
             from.name,
             n,
             all.text(samples),
             all.given == 0 ? "-" : fmt::format("{:.2f}", width / all.given),
             few_ties.text(samples),
             low_skewness.text(samples));
}

}  // namespace
}  // namespace loopbench::interval_coverage

int main(int count, char** arguments) {
  using namespace loopbench::interval_coverage;
  const int samples = count > 1 ? std::atoi(arguments[1]) : 40000;
  if (samples < 1) {
    fmt::print(stderr, "usage: interval_coverage [SAMPLES >= 1]\n");
    return 2;
  }
  fmt::print(
      "| values | n | covers [%] | given [%] | width / Student's | "
      "at most half ties: covers [%] | given [%] | skewness <= 1.5: covers [%] | given [%] |\n"
      "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  Draws draws;
  for (const Distribution& each : kDistributions) {
    for (const std::size_t n : {8u, 10u, 15u, 20u, 30u}) print_row(each, n, samples, draws);
  }
}
