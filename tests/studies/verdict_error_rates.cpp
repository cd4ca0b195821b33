/// Measures error rates of verdicts and coverage of intervals on synthetic records.
/// Prints Markdown; exits with 1 if a rate is outside its limits. Usage: verdict_error_rates
/// [repeats], or verdict_error_rates repeats methods runs for one cell of the table of equal
/// methods.
#include <fmt/format.h>
#include <fmt/ranges.h>

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
  const auto equal = [](std::size_t methods) { return std::vector<double>(methods, 0.0); };
  return {
      {"2 equal methods, 8 groups of 5 runs, correlation 0.9",
       {.effects = equal(2), .groups = 8, .runs_in_group = 5, .shared = 0.75}},
      {"4 equal methods, 12 groups of 5 runs, correlation 0.9",
       {.effects = equal(4), .groups = 12, .runs_in_group = 5, .shared = 0.75}},
      {"4 equal methods, 10 runs, each twice", {.effects = equal(4), .groups = 10, .copies = 1.0}},
      {"2 equal methods, 8 recordings with 10 near-copies each",
       {.effects = equal(2), .groups = 8, .runs_in_group = 10, .shared = 0.999}},
      {"4 equal methods that fail on 0, 10, 10 and 30 %, 20 runs",
       {.effects = equal(4), .groups = 20, .failures = {0.0, 0.1, 0.1, 0.3}}},
      {"3 equal methods, the last diverges on 20 %, 20 runs",
       {.effects = equal(3), .groups = 20, .diverges = 0.2}},
      {"2 equal methods, 64 runs of 4 sequences with effects -20, -7, 7, 20 %",
       {.effects = equal(2),
        .groups = 64,
        .sequences = {{0.0, -0.2}, {0.0, -0.07}, {0.0, 0.07}, {0.0, 0.2}}}},
      {"3 equal systems, 10 independent runs of each of 3 sequences",
       {.effects = equal(3), .groups = 30, .sequences = {3, equal(3)}, .is_independent = true}},
      {"2 best of 4, 20 runs", {.effects = {0.0, -0.3, -0.3, 0.1}, .groups = 20}},
      {"best of 4 by 30 %, 20 runs", {.effects = {0.0, -0.35, 0.0, 0.1}, .groups = 20}},
      {"best of 3 by 30 %, the last diverges on 20 %, 20 runs",
       {.effects = {0.0, -0.35, 0.0}, .groups = 20, .diverges = 0.2}},
      {"best of 4 by 30 %, fails on 10 %, 20 runs",
       {.effects = {0.0, -0.35, 0.0, 0.1}, .groups = 20, .failures = {0.0, 0.1, 0.0, 0.0}}},
      {"best of 3 by 30 %, the last fails on 95 %, 24 runs",
       {.effects = {0.0, -0.35, -0.5}, .groups = 24, .failures = {0.0, 0.0, 0.95}}},
      {"better by 50 %, a failure in each of 8 groups of 20 runs",
       {.effects = {0.0, -0.69}, .groups = 8, .runs_in_group = 20, .failures = {0.0, 0.05}}},
      {"baseline is 20 % better, the other fails on the hard third, 20 runs",
       {.effects = {0.0, 0.18}, .groups = 20, .hard = 0.33, .fails_hard = 1.0}},
  };
}

/// 5 % plus four standard errors of such a rate.
double limit(int repeats) { return 0.05 + 4.0 * std::sqrt(0.05 * 0.95 / repeats); }

/// Largest rates over the distributions.
ErrorRates largest_rates(const Truth& truth, int repeats, double& least_found) {
  ErrorRates most;
  least_found = 1.0;
  for (const Shape& shape : shapes()) {
    const ErrorRates r = error_rates(truth, shape, repeats, 7);
    least_found = std::min(least_found, r.found);
    most = {.false_best = std::max(most.false_best, r.false_best),
            .false_better = std::max(most.false_better, r.false_better),
            .found = std::max(most.found, r.found)};
  }
  return most;
}

double worst(const ErrorRates& r) { return std::max(r.false_best, r.false_better); }

/// Share of false claims among equal methods.
double equal_rate(std::size_t methods, std::size_t groups, int repeats) {
  double found = 0.0;
  const Truth truth{.effects = std::vector<double>(methods, 0.0), .groups = groups};
  return worst(largest_rates(truth, repeats, found));
}

/// A row per number of methods, a column per number of runs.
bool print_equal(int repeats) {
  bool is_good = true;
  const std::vector<std::size_t> runs{3, 6, 8, 15, 40, 100};
  fmt::print("| equal methods | {} runs |\n| ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
             fmt::join(runs, " | "));
  for (const std::size_t methods : {2u, 4u, 7u, 21u}) {
    fmt::print("| {} |", methods);
    for (const std::size_t groups : runs) {
      const double rate = equal_rate(methods, groups, repeats);
      is_good = is_good && rate <= limit(repeats);
      fmt::print(" {:.1f} |", 100.0 * rate);
      std::fflush(stdout);
    }
    fmt::print("\n");
  }
  return is_good;
}

/// One row a scene.
bool print_error_rates(const std::vector<Scene>& all, int repeats) {
  bool is_good = true;
  fmt::print(
      "\n| records | false best [%] | any false claim [%] | best found [%] |\n"
      "| --- | ---: | ---: | ---: |\n");
  for (const Scene& scene : all) {
    double least_found = 0.0;
    const ErrorRates most = largest_rates(scene.truth, repeats, least_found);
    is_good = is_good && worst(most) <= limit(repeats);
    const std::string found =
        most.found > 0.0 ? fmt::format("{:.1f} to {:.1f}", 100.0 * least_found, 100.0 * most.found)
                         : "none";
    fmt::print("| {} | {:.1f} | {:.1f} | {} |\n",
               scene.name,
               100.0 * most.false_best,
               100.0 * most.false_better,
               found);
    std::fflush(stdout);
  }
  return is_good;
}

/// At least 94 %, less four standard errors for the number of intervals.
bool is_covered(const IntervalCoverage& c, int repeats) {
  const double given = std::max(1.0, repeats * (1.0 - c.declined));
  return c.declined == 1.0 || c.covered >= 0.94 - 4.0 * std::sqrt(0.06 * 0.94 / given);
}

struct PowerCase {
  std::size_t methods = 2;
  std::size_t groups = 8;
};

/// Share of draws in which a method that is 20 % better, with a deviation of log ratios of 0.3, is
/// significantly better than the baseline; others are equal to it.
void print_power(int repeats) {
  fmt::print("\n| methods | runs | 20 % are found [%] |\n| ---: | ---: | ---: |\n");
  for (const PowerCase& one : {PowerCase{2, 8}, {2, 15}, {2, 40}, {7, 8}, {7, 15}, {7, 40}}) {
    Truth truth{.effects = std::vector<double>(one.methods, 0.0),
                .groups = one.groups,
                .dispersion = 0.3 / std::sqrt(2.0)};
    truth.effects[1] = std::log(0.8);
    const double found = power(truth, shapes()[0], repeats, 13);
    fmt::print("| {} | {} | {:.0f} |\n", one.methods, one.groups, 100.0 * found);
  }
}

std::vector<Scene> coverage_cases() {
  std::vector<Scene> out;
  for (const std::size_t n : {6u, 8u, 15u, 30u, 100u}) {
    out.push_back({fmt::format("{} runs", n), {.effects = {0.0, -0.2}, .groups = n}});
  }
  out.push_back({"7 methods, 15 runs, all intervals hold",
                 {.effects = {0.0, -0.2, -0.2, 0.0, 0.1, 0.0, -0.1}, .groups = 15}});
  out.push_back({"21 equal methods, 20 runs, all intervals hold",
                 {.effects = std::vector<double>(21, 0.0), .groups = 20}});
  out.push_back({"64 runs of 4 sequences with effects -80, -40, -20 and -10 %",
                 {.effects = {0.0, 0.0},
                  .groups = 64,
                  .sequences = {{0.0, -1.6}, {0.0, -0.5}, {0.0, -0.2}, {0.0, -0.1}}}});
  out.push_back({"30 runs, ratios as skewed as the shape",
                 {.effects = {0.0, -0.2}, .groups = 30, .baseline_is_fixed = true}});
  return out;
}

/// Smallest and largest coverage over the distributions; skewed ratios are reported, not judged.
bool print_coverage(int repeats) {
  bool is_good = true;
  fmt::print(
      "\n| observations | 95 % intervals that hold the typical ratio [%] | declined [%] |\n"
      "| --- | ---: | ---: |\n");
  for (const Scene& one : coverage_cases()) {
    double least = 1.0;
    double most = 0.0;
    double declined = 0.0;
    std::string worst;
    for (const Shape& shape : shapes()) {
      const IntervalCoverage c = coverage(one.truth, shape, repeats, 9);
      if (c.covered < least) worst = shape.name;
      least = std::min(least, c.covered);
      most = std::max(most, c.covered);
      declined = std::max(declined, c.declined);
      is_good = is_good && (one.truth.baseline_is_fixed || is_covered(c, repeats));
    }
    fmt::print("| {} | {:.1f} ({}) to {:.1f} | {:.1f} |\n",
               one.name,
               100.0 * least,
               worst,
               100.0 * most,
               100.0 * declined);
    std::fflush(stdout);
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
  if (repeats < 1 || (count > 2 && count != 4)) {
    fmt::print(stderr, "usage: verdict_error_rates [REPEATS >= 1 [METHODS RUNS]]\n");
    return 2;
  }
  if (count == 4) {
    const auto number = [&](int i) { return static_cast<std::size_t>(std::atoi(arguments[i])); };
    const double rate = equal_rate(number(2), number(3), repeats);
    fmt::print("{:.2f} %, {:.0f} s\n", 100.0 * rate, seconds());
    return rate <= limit(repeats) ? 0 : 1;
  }
  const std::vector<Scene> all = scenes();
  bool is_good = print_equal(repeats);
  is_good = print_error_rates(all, repeats) && is_good;
  is_good = print_coverage(repeats) && is_good;
  print_power(repeats);
  fmt::print("\n{:.0f} s in all\n", seconds());
  return is_good ? 0 : 1;
} catch (const std::exception& error) {
  fmt::print(stderr, "verdict_error_rates: {}\n", error.what());
  return 2;
}
