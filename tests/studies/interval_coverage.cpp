/// Measures the coverage of mean_interval's 95 % intervals by distribution and number of values,
/// and their width. Prints Markdown (results/methods/intervals.md); exits with 1 if the intervals
/// of a distribution on which the rule was chosen cover less than 93 or more than 97 %. Usage:
/// interval_coverage [samples].
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "harness/statistics/average.hpp"
#include "harness/statistics/mean_interval.hpp"
#include "harness/statistics/student.hpp"

namespace loopbench::interval_coverage {
namespace {

using Sample = std::vector<double>;

constexpr std::size_t kCounts[] = {8, 9, 10, 12, 15, 20, 30, 60, 100};

/// Random numbers that do not depend on the standard library.
class Draws {
 public:
  double uniform() { return (static_cast<double>(bits_() >> 11) + 0.5) * 0x1p-53; }
  double exponential() { return -std::log(uniform()); }
  double normal() { return std::sqrt(2.0 * exponential()) * std::cos(2.0 * M_PI * uniform()); }
  /// Student's t.
  double student(int freedom) {
    double squares = 0.0;
    for (int i = 0; i < freedom; ++i) squares += std::pow(normal(), 2);
    return normal() / std::sqrt(squares / freedom);
  }
  /// One of two clusters; `share` is the lower one's.
  double cluster(double share) { return (uniform() < share ? -1.0 : 1.0) + 0.3 * normal(); }

 private:
  std::mt19937_64 bits_{11};
};

struct Distribution {
  const char* name;
  double mean;
  double (*draw)(Draws&);
};

const Distribution kChosenOn[] = {
    {"normal", 0.0, [](Draws& d) { return d.normal(); }},
    {"uniform", 0.5, [](Draws& d) { return d.uniform(); }},
    {"Laplace", 0.0, [](Draws& d) { return d.exponential() - d.exponential(); }},
    {"t, 3 degrees of freedom", 0.0, [](Draws& d) { return d.student(3); }},
    {"normal, one in ten 5 times as wide",
     0.0,
     [](Draws& d) { return (d.uniform() < 0.1 ? 5.0 : 1.0) * d.normal(); }},
    {"gamma 4",
     4.0,
     [](Draws& d) {
       return d.exponential() + d.exponential() + d.exponential() + d.exponential();
     }},
    {"lognormal 0.5", std::exp(0.125), [](Draws& d) { return std::exp(0.5 * d.normal()); }},
    {"exponential", 1.0, [](Draws& d) { return d.exponential(); }},
    {"lognormal 0.75", std::exp(0.28125), [](Draws& d) { return std::exp(0.75 * d.normal()); }},
    {"Weibull 0.7",
     std::tgamma(1.0 + 1.0 / 0.7),
     [](Draws& d) { return std::pow(d.exponential(), 1.0 / 0.7); }},
    {"lognormal 1", std::exp(0.5), [](Draws& d) { return std::exp(d.normal()); }},
};

const Distribution kHeldOut[] = {
    {"t, 5 degrees of freedom", 0.0, [](Draws& d) { return d.student(5); }},
    {"triangular, symmetric", 1.0, [](Draws& d) { return d.uniform() + d.uniform(); }},
    {"triangular, skewed", 1.0 / 3.0, [](Draws& d) { return std::min(d.uniform(), d.uniform()); }},
    {"Gumbel", 0.57721566490153286, [](Draws& d) { return -std::log(d.exponential()); }},
    {"gamma 0.5", 0.5, [](Draws& d) { return 0.5 * std::pow(d.normal(), 2); }},
    {"beta (0.5, 2)",
     0.2,
     [](Draws& d) {
       const double a = 0.5 * std::pow(d.normal(), 2);
       return a / (a + d.exponential() + d.exponential());
     }},
    {"beta (0.5, 0.5)", 0.0, [](Draws& d) { return std::cos(M_PI * d.uniform()); }},
    {"two clusters, 30 and 70 %", 0.4, [](Draws& d) { return d.cluster(0.3); }},
    {"two clusters, 50 % each", 0.0, [](Draws& d) { return d.cluster(0.5); }},
};

/// A method that equals the baseline on some runs.
const Distribution kTiesChosenOn[] = {
    {"half 0, half normal", 0.0, [](Draws& d) { return d.uniform() < 0.5 ? 0.0 : d.normal(); }},
    {"half 0, half normal + 1",
     0.5,
     [](Draws& d) { return d.uniform() < 0.5 ? 0.0 : d.normal() + 1.0; }},
    {"half 0, half exponential",
     0.5,
     [](Draws& d) { return d.uniform() < 0.5 ? 0.0 : d.exponential(); }},
};

const Distribution kTiesHeldOut[] = {
    {"1/10 0, 9/10 exponential",
     0.9,
     [](Draws& d) { return d.uniform() < 0.1 ? 0.0 : d.exponential(); }},
    {"3/10 0, 7/10 exponential",
     0.7,
     [](Draws& d) { return d.uniform() < 0.3 ? 0.0 : d.exponential(); }},
    {"3/10 0, 7/10 normal + 1",
     0.7,
     [](Draws& d) { return d.uniform() < 0.3 ? 0.0 : d.normal() + 1.0; }},
    {"3/10 0, 7/10 normal + 3",
     2.1,
     [](Draws& d) { return d.uniform() < 0.3 ? 0.0 : d.normal() + 3.0; }},
    {"half 0, half normal + 3",
     1.5,
     [](Draws& d) { return d.uniform() < 0.5 ? 0.0 : d.normal() + 3.0; }},
    {"3/4 0, 1/4 normal", 0.0, [](Draws& d) { return d.uniform() < 0.75 ? 0.0 : d.normal(); }},
    {"3/4 0, 1/4 normal + 1",
     0.25,
     [](Draws& d) { return d.uniform() < 0.75 ? 0.0 : d.normal() + 1.0; }},
    {"3/4 0, 1/4 exponential",
     0.25,
     [](Draws& d) { return d.uniform() < 0.75 ? 0.0 : d.exponential(); }},
};

struct Coverage {
  int samples = 0;
  int given = 0;
  int covers = 0;
  int narrow = 0;  ///< narrower than Student's
  int narrow_covers = 0;
  double width = 0.0;  ///< sum of the ratios to Student's

  /// Within two points of 95 %, but for three standard errors.
  bool is_close() const {
    const double error = 3.0 * std::sqrt(0.05 * 0.95 / std::max(1, given));
    return given == 0 || std::abs(static_cast<double>(covers) / given - 0.95) <= 0.02 + error;
  }
};

Coverage coverage(const Distribution& from, std::size_t n, int samples, Draws& draws) {
  Coverage out{.samples = samples};
  const double student = 2.0 * harness::student_quantile(0.05, n - 1) / std::sqrt(double(n));
  Sample x(n);
  for (int i = 0; i < samples; ++i) {
    for (double& value : x) value = from.draw(draws);
    const auto found = harness::mean_interval(x);
    if (!found) continue;
    const auto [estimate, low, high] = found->interval;
    const int covers = low <= from.mean && from.mean <= high ? 1 : 0;
    const double width = (high - low) / (student * harness::sample_deviation(x));
    ++out.given;
    out.covers += covers;
    out.width += width;
    if (width >= 1.0 - 1e-9) continue;
    ++out.narrow;
    out.narrow_covers += covers;
  }
  return out;
}

std::string percent(double part, double of) {
  return of > 0.0 ? fmt::format("{:.1f}", 100.0 * part / of) : "-";
}

std::string covered(const Coverage& c) { return percent(c.covers, c.given); }

std::string covered_of_given(const Coverage& c) {
  return fmt::format("{} ({:.0f})", covered(c), 100.0 * c.given / c.samples);
}

std::string relative_width(const Coverage& c) { return fmt::format("{:.2f}", c.width / c.given); }

/// Coverage of the intervals that are narrower than Student's, and their share.
std::string covered_if_narrow(const Coverage& c) {
  return fmt::format("{} ({:.0f})", percent(c.narrow_covers, c.narrow), 100.0 * c.narrow / c.given);
}

using Table = std::vector<std::vector<Coverage>>;

Table measured(std::span<const Distribution> from, int samples, Draws& draws) {
  Table out;
  for (const Distribution& each : from) {
    out.emplace_back();
    for (const std::size_t n : kCounts) {
      out.back().push_back(coverage(each, n, samples, draws));
    }
  }
  return out;
}

bool is_close(const Table& table) {
  for (const std::vector<Coverage>& row : table) {
    for (const Coverage& each : row) {
      if (!each.is_close()) return false;
    }
  }
  return true;
}

void print(const char* title,
           std::span<const Distribution> from,
           const Table& table,
           std::string (*text)(const Coverage&)) {
  fmt::print("| {} |", title);
  for (const std::size_t n : kCounts) fmt::print(" {} |", n);
  fmt::print("\n| --- |");
  for (std::size_t i = 0; i < std::size(kCounts); ++i) fmt::print(" ---: |");
  fmt::print("\n");
  for (std::size_t d = 0; d < table.size(); ++d) {
    fmt::print("| {} |", from[d].name);
    for (const Coverage& each : table[d]) fmt::print(" {} |", text(each));
    fmt::print("\n");
  }
  fmt::print("\n");
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
  Draws draws;
  const Table chosen_on = measured(kChosenOn, samples, draws);
  const Table ties = measured(kTiesChosenOn, samples, draws);
  print("chosen on: covers [%]", kChosenOn, chosen_on, covered);
  print("held out: covers [%]", kHeldOut, measured(kHeldOut, samples, draws), covered);
  print("ties, chosen on: covers [%] (given [%])", kTiesChosenOn, ties, covered_of_given);
  print("ties, held out: covers [%] (given [%])",
        kTiesHeldOut,
        measured(kTiesHeldOut, samples, draws),
        covered_of_given);
  print("width / Student's", kChosenOn, chosen_on, relative_width);
  print("narrower than Student's: covers [%] (share [%])", kChosenOn, chosen_on, covered_if_narrow);
  return is_close(chosen_on) && is_close(ties) ? 0 : 1;
}
