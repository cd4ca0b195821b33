/// Measures error rates of verdicts and coverage of intervals on synthetic records and stores.
/// Prints Markdown; exits with 1 if a rate is outside its limits. Usage: verdict_error_rates
/// [repeats].
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "tests/studies/error_rates.hpp"

namespace {

using namespace loopbench;             // NOLINT
using namespace loopbench::metrics;    // NOLINT
using namespace loopbench::harness;    // NOLINT
using namespace loopbench::synthetic;  // NOLINT

struct Scene {
  std::string name;
  Truth truth;
};

std::vector<Scene> scenes() {
  const std::vector<double> four_equal(4, 0.0);
  return {
      {"2 equal methods, 6 runs (no interval)", {.effects = {0.0, 0.0}, .groups = 6}},
      {"2 equal methods, 8 runs", {.effects = {0.0, 0.0}, .groups = 8}},
      {"4 equal methods, 8 runs", {.effects = four_equal, .groups = 8}},
      {"4 equal methods, 30 runs", {.effects = four_equal, .groups = 30}},
      {"10 equal methods, 15 runs", {.effects = std::vector<double>(10, 0.0), .groups = 15}},
      {"2 equal methods, 8 groups of 5 runs, correlation 0.9",
       {.effects = {0.0, 0.0}, .groups = 8, .runs_in_group = 5, .shared = 0.75}},
      {"4 equal methods, 12 groups of 5 runs, correlation 0.9",
       {.effects = four_equal, .groups = 12, .runs_in_group = 5, .shared = 0.75}},
      {"4 equal methods, 10 runs, each twice",
       {.effects = four_equal, .groups = 10, .copies = 1.0}},
      {"4 equal methods that fail on 0, 10, 10 and 30 %, 20 runs",
       {.effects = four_equal, .groups = 20, .failures = {0.0, 0.1, 0.1, 0.3}}},
      {"2 equal methods, the baseline without deviation, 20 runs",
       {.effects = {0.0, 0.0}, .groups = 20, .baseline_is_fixed = true}},
      {"2 best of 4, 20 runs", {.effects = {0.0, -0.3, -0.3, 0.1}, .groups = 20}},
      {"best of 4 by 30 %, 20 runs", {.effects = {0.0, -0.35, 0.0, 0.1}, .groups = 20}},
      {"best of 4 by 30 %, fails on 10 %, 20 runs",
       {.effects = {0.0, -0.35, 0.0, 0.1}, .groups = 20, .failures = {0.0, 0.1, 0.0, 0.0}}},
  };
}

/// 5 % plus four standard errors of such a rate.
double limit(int repeats) { return 0.05 + 4.0 * std::sqrt(0.05 * 0.95 / repeats); }

/// Largest rates over the distributions; one row a scene.
bool print_error_rates(const std::vector<Scene>& all, int repeats, Through through) {
  bool is_good = true;
  fmt::print(
      "| records | false best [%] | wrong mark [%] | any false claim [%] | best found [%] |\n"
      "| --- | ---: | ---: | ---: | ---: |\n");
  for (const Scene& scene : all) {
    ErrorRates most;
    double least_found = 1.0;
    for (const Shape& shape : shapes()) {
      const ErrorRates r = error_rates(scene.truth, shape, repeats, 7, through);
      is_good =
          is_good && std::max({r.false_best, r.false_better, r.marked_wrong}) <= limit(repeats);
      least_found = std::min(least_found, r.found);
      most = {.false_best = std::max(most.false_best, r.false_best),
              .false_better = std::max(most.false_better, r.false_better),
              .found = std::max(most.found, r.found),
              .marked_wrong = std::max(most.marked_wrong, r.marked_wrong)};
    }
    const std::string found =
        most.found > 0.0 ? fmt::format("{:.1f} to {:.1f}", 100.0 * least_found, 100.0 * most.found)
                         : "none";
    fmt::print("| {} | {:.1f} | {:.1f} | {:.1f} | {} |\n",
               scene.name,
               100.0 * most.false_best,
               100.0 * most.marked_wrong,
               100.0 * most.false_better,
               found);
    std::fflush(stdout);
  }
  return is_good;
}

/// Limits of the coverage of 95 % intervals: two percentage points, three upwards for half ties,
/// plus four standard errors for the number of intervals.
bool is_covered(const std::string& shape, const IntervalCoverage& c, int repeats) {
  const double given = std::max(1.0, repeats * (1.0 - c.declined));
  const double error = 4.0 * std::sqrt(0.07 * 0.93 / given);
  const double high = shape == "half ties" ? 0.98 : 0.97;
  return c.declined == 1.0 || (c.covered >= 0.93 - error && c.covered <= high + error);
}

bool print_coverage(const std::vector<std::size_t>& counts, int repeats, Through through) {
  bool is_good = true;
  fmt::print(
      "\n| logarithms | n | 95 % intervals that hold the ratio [%] | declined [%] |\n"
      "| --- | ---: | ---: | ---: |\n");
  for (const Shape& shape : shapes()) {
    for (const std::size_t n : counts) {
      const Truth truth{.effects = {0.0, -0.2}, .groups = n, .baseline_is_fixed = true};
      const IntervalCoverage c = coverage(truth, shape, repeats, 9, through);
      fmt::print("| {} | {} | {} | {:.1f} |\n",
                 shape.name,
                 n,
                 c.declined == 1.0 ? "-" : fmt::format("{:.1f}", 100.0 * c.covered),
                 100.0 * c.declined);
      is_good = is_good && is_covered(shape.name, c, repeats);
    }
  }
  return is_good;
}

}  // namespace

int main(int count, char** arguments) try {
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const int repeats = count > 1 ? std::atoi(arguments[1]) : 2000;
  if (repeats < 1) {
    fmt::print(stderr, "usage: verdict_error_rates [REPEATS >= 1]\n");
    return 2;
  }
  const std::vector<Scene> all = scenes();
  bool is_good = print_error_rates(all, repeats, Through::memory);
  is_good = print_coverage({5, 6, 8, 10, 15, 20, 30}, repeats, Through::memory) && is_good;
  fmt::print(
      "\n{:.0f} s. The same through stores, {} of them a row:\n\n", seconds(), (repeats + 9) / 10);
  const std::vector<Scene> stored{all.at(1), all.at(5), all.at(8)};
  is_good = print_error_rates(stored, (repeats + 9) / 10, Through::store) && is_good;
  is_good = print_coverage({8, 15}, (repeats + 9) / 10, Through::store) && is_good;
  fmt::print("\n{:.0f} s in all\n", seconds());
  return is_good ? 0 : 1;
} catch (const std::exception& error) {
  fmt::print(stderr, "verdict_error_rates: {}\n", error.what());
  return 2;
}
