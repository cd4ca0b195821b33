/// Measures how often the statements of comparisons are false, and how often the best method is
/// found, on synthetic errors with known truth. Prints tables in Markdown; exits with 1 if a rate
/// is too high, two statements contradict each other, or the power is below that of Wilcoxon's test
/// with Holm's correction over the rivals. A cell gets a quarter of the repeats, all of them if a
/// rate exceeds 4 %, and new ones, four times as many, if these do not tell it from the limit.
/// Usage: verdict_error_rates [REPEATS [methods|sequences|failures|power|wilcoxon]]
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "tests/studies/error_rates.hpp"

namespace {

using namespace loopbench::synthetic;  // NOLINT

std::vector<Shape> studied_shapes() {
  std::vector<Shape> out;
  for (const Shape& shape : shapes()) {
    if (shape.name == "normal" || shape.name == "student 3" || shape.name == "lognormal 1")
      out.push_back(shape);
  }
  return out;
}

/// The largest rate that 2,000 or so repeats tell from 5 %: its 95 % interval ends at 6.5 %.
bool is_low(double rate, int repeats) {
  return rate + 2.0 * std::sqrt(rate * (1.0 - rate) / repeats) <=
         std::max(0.065, 0.05 + 3.0 * std::sqrt(0.05 * 0.95 / repeats));
}

struct Measured {
  ErrorRates rates;
  int repeats = 0;

  bool is_good() const {
    const int with_intervals = std::max(1, static_cast<int>(rates.intervals * repeats + 0.5));
    return is_low(std::max({rates.baseline, rates.best, rates.sequences, rates.failures}),
                  repeats) &&
           is_low(rates.missed, with_intervals) && rates.contradicted == 0.0;
  }
};

/// By a quarter of the repeats, by all if a rate is near the limit, and by new ones, four times as
/// many, if they do not tell it from the limit.
Measured measured(const Truth& truth, const Shape& shape, int repeats) {
  constexpr double kNear = 0.04;
  const int few = std::max(1, repeats / 4);
  const ErrorRates first = error_rates(truth, shape, few, 7);
  if (first.largest() <= kNear) return {first, few};
  const Measured out{error_rates(truth, shape, repeats, 7), repeats};
  if (out.is_good()) return out;
  return {error_rates(truth, shape, 4 * repeats, 8), 4 * repeats};
}

/// The largest rates over the distributions.
bool print_rates(const Truth& truth, int repeats) {
  ErrorRates most;
  bool is_good = true;
  for (const Shape& shape : studied_shapes()) {
    const Measured found = measured(truth, shape, repeats);
    const ErrorRates& r = found.rates;
    is_good = is_good && found.is_good();
    most = {.baseline = std::max(most.baseline, r.baseline),
            .best = std::max(most.best, r.best),
            .sequences = std::max(most.sequences, r.sequences),
            .failures = std::max(most.failures, r.failures),
            .missed = std::max(most.missed, r.missed),
            .contradicted = std::max(most.contradicted, r.contradicted)};
  }
  fmt::print(" {:.1f}/{:.1f}/{:.1f}/{:.1f}{} |",
             100.0 * most.baseline,
             100.0 * most.best,
             100.0 * std::max(most.sequences, most.failures),
             100.0 * most.missed,
             is_good ? "" : " (!)");
  std::fflush(stdout);
  if (most.contradicted > 0.0) fmt::print("\n{:.2f} % contradict\n", 100.0 * most.contradicted);
  return is_good;
}

/// A row per number of methods; runs of one sequence, then of four.
bool print_error_rates(int repeats) {
  fmt::print(
      "| truth | 8 | 15 | 40 runs | 4 x 3 | 4 x 8 | 4 x 20 runs |\n"
      "| --- | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  const auto others = [](std::size_t methods, std::size_t best) {
    std::vector<double> out(methods, 0.3);
    std::fill_n(out.begin(), best, 0.0);
    return out;
  };
  struct Row {
    std::string name;
    std::vector<double> effects;
  };
  bool is_good = true;
  for (const Row& row : {Row{"2 equal", others(2, 2)},
                         {"4 equal", others(4, 4)},
                         {"7 equal", others(7, 7)},
                         {"21 equal", others(21, 21)},
                         {"2 best of 4", others(4, 2)},
                         {"3 best of 7", others(7, 3)}}) {
    fmt::print("| {} |", row.name);
    const bool is_many = row.effects.size() > 7;
    for (const auto& [sequences, runs] :
         {std::pair{1u, 8u}, {1u, 15u}, {1u, 40u}, {4u, 3u}, {4u, 8u}, {4u, 20u}}) {
      const Truth truth{.effects = row.effects,
                        .groups = sequences * runs,
                        .sequences = {sequences, std::vector<double>(row.effects.size())}};
      is_good = print_rates(truth, is_many ? std::max(1, repeats / 2) : repeats) && is_good;
    }
    fmt::print("\n");
  }
  return is_good;
}

/// Effects of method 1 by sequence, and their scatter.
struct Sequences {
  std::string name;
  std::vector<double> effects;
  std::vector<double> scatter;
};

/// Two methods on sequences that differ.
bool print_sequences(int repeats) {
  fmt::print(
      "\n| effects by sequence, standard deviations | 3 | 5 | 8 | 20 runs |\n"
      "| --- | ---: | ---: | ---: | ---: |\n");
  const std::vector<double> one_noisy{1.0, 0.1, 0.1, 0.1}, mixed{0.1, 0.3, 0.5, 0.8};
  bool is_good = true;
  for (const Sequences& row :
       {Sequences{"0; 1 / .1 / .1 / .1", {0, 0, 0, 0}, one_noisy},
        {".45 -.15 -.15 -.15; 1 / .1 / .1 / .1", {.45, -.15, -.15, -.15}, one_noisy},
        {".46 -.1 -.1 -.1; 1 / .1 / .1 / .1", {.46, -.1, -.1, -.1}, one_noisy},
        {"-.1 -.1 -.1 .3; .1 / .3 / .5 / .8", {-.1, -.1, -.1, .3}, mixed},
        {".34 -.06 -.06 -.06; .1 / .3 / .5 / .8", {.34, -.06, -.06, -.06}, mixed},
        {".3 -.3; .3 / .3", {.3, -.3}, {.3, .3}},
        {".3 -.3; 1 / .1", {.3, -.3}, {1.0, .1}},
        {".2 -.2 0; .3", {.2, -.2, 0}, {.3, .3, .3}},
        {".2 -.2 0 ...; nine of .3", {.2, -.2, 0, .2, -.2, 0, .2, -.2, 0}, std::vector(9, .3)},
        {"0; twenty of .3", std::vector(20, 0.0), std::vector(20, .3)}}) {
    fmt::print("| {} |", row.name);
    for (const std::size_t runs : {3u, 5u, 8u, 20u}) {
      Truth truth{.effects = {0.0, 0.0},
                  .groups = runs * row.effects.size(),
                  .dispersion = 1.0 / std::sqrt(2.0),
                  .dispersions = row.scatter};
      for (const double effect : row.effects) truth.sequences.push_back({0.0, effect});
      const Measured found = measured(truth, shapes()[0], repeats);
      const ErrorRates& r = found.rates;
      fmt::print(" {:.1f}/{:.1f}/{:.1f}{} |",
                 100.0 * std::max(r.baseline, r.best),
                 100.0 * r.sequences,
                 100.0 * r.missed,
                 found.is_good() ? "" : " (!)");
      std::fflush(stdout);
      is_good = is_good && found.is_good();
    }
    fmt::print("\n");
  }
  return is_good;
}

/// Four methods of which those that are better fail, and ratios to a baseline without scatter.
bool print_failures(int repeats) {
  fmt::print(
      "\n| truth | 6 | 10 | 20 runs |\n"
      "| --- | ---: | ---: | ---: |\n");
  struct Row {
    std::string name;
    Truth truth;
  };
  bool is_good = true;
  for (const Row& row :
       {Row{"equal, one fails on 10 %", {.effects = {0, 0, 0, 0}, .failures = {0, .1, 0, 0}}},
        {"equal, one fails on 30 %", {.effects = {0, 0, 0, 0}, .failures = {0, .3, 0, 0}}},
        {"equal, all fail on 30 %", {.effects = {0, 0, 0, 0}, .failures = {.3, .3, .3, .3}}},
        {"30 % better, fails on 10 %", {.effects = {0, -.36, 0, 0}, .failures = {0, .1, 0, 0}}},
        {"30 % better, fails on 30 %", {.effects = {0, -.36, 0, 0}, .failures = {0, .3, 0, 0}}},
        {"equal, baseline without scatter",
         {.effects = {0, 0, 0, 0}, .baseline_is_fixed = true}}}) {
    fmt::print("| {} |", row.name);
    for (const std::size_t runs : {6u, 10u, 20u}) {
      Truth truth = row.truth;
      truth.groups = runs;
      truth.sequences = {std::vector<double>(4)};
      is_good = print_rates(truth, repeats) && is_good;
    }
    fmt::print("\n");
  }
  return is_good;
}

struct PowerCase {
  std::size_t methods;
  std::size_t sequences;
  std::size_t runs;
  double gain;
};

/// How often the only best method is found, with a standard deviation of log errors of 0.3.
bool print_power(int repeats) {
  fmt::print(
      "\n| methods | runs | better by | below the baseline | best is found | Wilcoxon-Holm |\n"
      "| ---: | ---: | ---: | ---: | ---: | ---: |\n");
  bool is_good = true;
  for (const PowerCase& one : {PowerCase{2, 1, 8, 0.3},
                               {4, 1, 8, 0.3},
                               {4, 1, 15, 0.2},
                               {7, 1, 15, 0.2},
                               {7, 1, 40, 0.2},
                               {4, 4, 3, 0.25},
                               {4, 4, 5, 0.2},
                               {4, 4, 8, 0.2}}) {
    Truth truth{.effects = std::vector<double>(one.methods, 0.0),
                .groups = one.sequences * one.runs,
                .sequences = {one.sequences, std::vector<double>(one.methods)}};
    truth.effects[1] = std::log(1.0 - one.gain);
    const ErrorRates r = error_rates(truth, shapes()[0], repeats, 13);
    fmt::print("| {} | {} x {} | {:.0f} % | {:.1f} % | {:.1f} % | {:.1f} % |\n",
               one.methods,
               one.sequences,
               one.runs,
               100.0 * one.gain,
               100.0 * r.claimed,
               100.0 * r.found,
               100.0 * r.holm);
    std::fflush(stdout);
    const double least = one.runs < 5 ? r.holm - 0.05 : r.holm;
    is_good = is_good && r.found >= least - 2.0 * std::sqrt(r.holm * (1.0 - r.holm) / repeats);
  }
  return is_good;
}

/// Three runs of each of four sequences whose mean effect is 0: how often two methods are said to
/// differ, by the verdict and by Wilcoxon's test, which is not about that mean.
bool print_wilcoxon(int repeats) {
  fmt::print(
      "\n| effects; standard deviations | verdict | Wilcoxon |\n"
      "| --- | ---: | ---: |\n");
  const std::vector<double> one_noisy{1.0, 0.1, 0.1, 0.1};
  bool is_good = true;
  for (const Sequences& row :
       {Sequences{"0; .3 / .3 / .3 / .3", {0, 0, 0, 0}, std::vector(4, .3)},
        {"0; 1 / .1 / .1 / .1", {0, 0, 0, 0}, one_noisy},
        {".45 -.15 -.15 -.15; 1 / .1 / .1 / .1", {.45, -.15, -.15, -.15}, one_noisy},
        {".3 -.1 -.1 -.1; .5 / .1 / .1 / .1", {.3, -.1, -.1, -.1}, {.5, .1, .1, .1}}}) {
    Truth truth{.effects = {0.0, 0.0},
                .groups = 12,
                .dispersion = 1.0 / std::sqrt(2.0),
                .dispersions = row.scatter};
    for (const double effect : row.effects) truth.sequences.push_back({0.0, effect});
    const ErrorRates r = error_rates(truth, shapes()[0], repeats, 7);
    fmt::print("| {} | {:.1f} % | {:.1f} % |\n", row.name, 100.0 * r.baseline, 100.0 * r.wilcoxon);
    std::fflush(stdout);
    is_good = is_good && is_low(r.baseline, repeats);
  }
  return is_good;
}

}  // namespace

int main(int count, char** arguments) try {
  const auto start = std::chrono::steady_clock::now();
  const int repeats = count > 1 ? std::atoi(arguments[1]) : 2000;
  const std::string only = count > 2 ? arguments[2] : "";
  bool is_good = true;
  bool is_known = only.empty();
  using Print = bool (*)(int);
  const std::array<std::pair<std::string, Print>, 5> tables{{{"methods", print_error_rates},
                                                             {"sequences", print_sequences},
                                                             {"failures", print_failures},
                                                             {"power", print_power},
                                                             {"wilcoxon", print_wilcoxon}}};
  for (const auto& [name, print] : tables) {
    if (repeats < 1 || (!only.empty() && only != name)) continue;
    is_known = true;
    is_good = print(repeats) && is_good;
  }
  if (repeats < 1 || count > 3 || !is_known) {
    fmt::print(stderr,
               "usage: verdict_error_rates [REPEATS >= 1 "
               "[methods|sequences|failures|power|wilcoxon]]\n");
    return 2;
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  fmt::print("\n{:.0f} s in all\n", took.count());
  return is_good ? 0 : 1;
} catch (const std::exception& error) {
  fmt::print(stderr, "verdict_error_rates: {}\n", error.what());
  return 2;
}
