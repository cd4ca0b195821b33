/// Measures how often the statements of comparisons are false, and how often the best method is
/// found, on synthetic errors with known truth. Prints two tables in Markdown; exits with 1 if a
/// rate is above 5 % by more than two standard errors, or the power is below that of Wilcoxon's
/// test with Holm's correction over the rivals. Usage: verdict_error_rates [REPEATS]
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

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

/// The largest rates over the distributions.
bool print_rates(const Truth& truth, int repeats) {
  ErrorRates most;
  for (const Shape& shape : studied_shapes()) {
    const ErrorRates r = error_rates(truth, shape, repeats, 7);
    most = {.baseline = std::max(most.baseline, r.baseline),
            .best = std::max(most.best, r.best),
            .sequences = std::max(most.sequences, r.sequences)};
  }
  fmt::print(" {:.1f}/{:.1f}", 100.0 * most.baseline, 100.0 * most.best);
  if (!truth.sequences.empty()) fmt::print("/{:.1f}", 100.0 * most.sequences);
  fmt::print(" |");
  std::fflush(stdout);
  return most.largest() <= 0.05 + 2.0 * std::sqrt(0.05 * 0.95 / repeats);
}

/// A row per number of methods; runs that are independent, then of four sequences.
bool print_error_rates(int repeats) {
  fmt::print(
      "| truth | 8 | 15 | 40 runs | 4 x 8 | 4 x 15 | 4 x 40 runs |\n"
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
    for (const std::size_t sequences : {0u, 4u}) {
      for (const std::size_t runs : {8u, 15u, 40u}) {
        const Truth truth{.effects = row.effects,
                          .groups = sequences == 0 ? runs : sequences * runs,
                          .sequences = {sequences, std::vector<double>(row.effects.size())}};
        is_good = print_rates(truth, repeats) && is_good;
      }
    }
    fmt::print("\n");
  }
  return is_good;
}

struct PowerCase {
  std::size_t methods;
  std::size_t runs;
  double gain;
};

/// How often the only best method is found, with a standard deviation of log errors of 0.3.
bool print_power(int repeats) {
  fmt::print(
      "\n| methods | runs | better by | best is found | Wilcoxon-Holm |\n"
      "| ---: | ---: | ---: | ---: | ---: |\n");
  bool is_good = true;
  for (const PowerCase& one : {PowerCase{4, 15, 0.2}, {7, 15, 0.2}, {4, 8, 0.3}, {7, 40, 0.2}}) {
    Truth truth{.effects = std::vector<double>(one.methods, 0.0), .groups = one.runs};
    truth.effects[1] = std::log(1.0 - one.gain);
    const ErrorRates r = error_rates(truth, shapes()[0], repeats, 13);
    fmt::print("| {} | {} | {:.0f} % | {:.1f} % | {:.1f} % |\n",
               one.methods,
               one.runs,
               100.0 * one.gain,
               100.0 * r.found,
               100.0 * r.holm);
    is_good = is_good && r.found >= r.holm - 2.0 * std::sqrt(r.holm * (1.0 - r.holm) / repeats);
  }
  return is_good;
}

}  // namespace

int main(int count, char** arguments) try {
  const auto start = std::chrono::steady_clock::now();
  const int repeats = count > 1 ? std::atoi(arguments[1]) : 4000;
  if (repeats < 1 || count > 2) {
    fmt::print(stderr, "usage: verdict_error_rates [REPEATS >= 1]\n");
    return 2;
  }
  bool is_good = print_error_rates(repeats);
  is_good = print_power(repeats) && is_good;
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  fmt::print("\n{:.0f} s in all\n", took.count());
  return is_good ? 0 : 1;
} catch (const std::exception& error) {
  fmt::print(stderr, "verdict_error_rates: {}\n", error.what());
  return 2;
}
