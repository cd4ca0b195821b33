// Errors of motion_drift relative to those of dual:
//   motion_drift_study DATA > chains.md    development chains, complete and in sections
//   motion_drift_study > controls.md       simulated controls with known drift, 50 seeds each
#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <memory>
#include <utility>

#include "datasets/core/parallel.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/correctors/motion_drift/motion_drift.hpp"
#include "tests/studies/development_chains.hpp"
#include "tests/studies/drift_controls.hpp"

namespace loopbench {

using namespace methods;

namespace {

/// Logarithms of ATE / ATE of dual, one list per column.
using LogRatios = std::vector<std::vector<double>>;

/// Columns: dual with rescaled covariances, motion_drift that never abstains, motion_drift.
std::vector<double> log_ratios(const DevelopmentChain& chain) {
  Report report;
  const auto error = [&](const Corrector& method) {
    return std::log(rmse_of(method.correct(chain.problem, report), chain));
  };
  const double dual = error(Dual({}));
  return {error(Dual({.rescale = true})) - dual,
          error(MotionDrift({.abstain_closures = 0})) - dual,
          error(MotionDrift({})) - dual};
}

/// "0.83 (1.43; 15)": geometric mean, worst, number above 1.05.
std::string cell(const std::vector<double>& logs) {
  double mean = 0.0, worst = 0.0;
  int above = 0;
  for (const double log : logs) {
    mean += log / static_cast<double>(logs.size());
    worst = std::max(worst, std::exp(log));
    above += std::exp(log) > 1.05;
  }
  return fmt::format("{:.2f} ({:.2f}; {})", std::exp(mean), worst, above);
}

void print_row(const std::string& name, const LogRatios& columns) {
  fmt::print("| {} | {} |", name, columns.front().size());
  for (const std::vector<double>& logs : columns) fmt::print(" {} |", cell(logs));
  fmt::print("\n");
}

/// One row per group, in order of appearance.
void print_table(const std::string& group,
                 const std::vector<std::string>& columns,
                 const std::vector<std::pair<std::string, std::vector<double>>>& chains) {
  fmt::print("| {} | chains |", group);
  for (const std::string& column : columns) fmt::print(" {} |", column);
  fmt::print("\n| --- | ---: |");
  for (std::size_t i = 0; i < columns.size(); ++i) fmt::print(" ---: |");
  fmt::print("\n");
  LogRatios one(columns.size()), all(columns.size());
  for (std::size_t i = 0; i < chains.size(); ++i) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      one[c].push_back(chains[i].second[c]);
      all[c].push_back(chains[i].second[c]);
    }
    if (i + 1 < chains.size() && chains[i + 1].first == chains[i].first) continue;
    print_row(chains[i].first, one);
    one.assign(columns.size(), {});
  }
  print_row("all", all);
}

template <class Compute>
auto computed(std::size_t size, Compute compute) {
  std::vector<std::pair<std::string, std::vector<double>>> out(size);
  std::atomic<std::size_t> next{0};
  parallel_invoke(hardware_threads(), [&](std::size_t) {
    for (std::size_t i = next++; i < size; i = next++) out[i] = compute(i);
  });
  return out;
}

void print_chains(const DataRoot& root) {
  const std::vector<DevelopmentChain> chains = development_chains(root);
  print_table("odometer",
              {"dual rescaled", "never abstains", "motion_drift"},
              computed(chains.size(), [&](std::size_t i) {
                return std::pair{chains[i].odometer, log_ratios(chains[i])};
              }));
}

/// The control with five others of its kind as related chains.
DevelopmentChain with_related(const std::vector<DriftControl>& controls, std::size_t i) {
  constexpr std::size_t kRelated = 5;
  DevelopmentChain out = controls[i].chain;
  std::vector<Problem> related;
  for (std::size_t j = 1; related.size() < kRelated; ++j) {
    const DevelopmentChain& other = controls[(i + j) % controls.size()].chain;
    if (other.name == out.name) related.push_back(other.problem);
  }
  out.problem.related = std::make_shared<const std::vector<Problem>>(std::move(related));
  return out;
}

void print_controls(double gain) {
  const std::vector<DriftControl> controls = drift_controls(gain);
  fmt::print("\nNoise gain {}:\n\n", gain);
  print_table("control",
              {"drift known", "dual rescaled", "never abstains", "motion_drift", "related"},
              computed(controls.size(), [&](std::size_t i) {
                const DriftControl& control = controls[i];
                std::vector<double> logs = log_ratios(control.chain);
                Report report;
                const auto dual = [&](const DevelopmentChain& chain) {
                  return std::log(rmse_of(Dual({}).correct(chain.problem, report), chain));
                };
                logs.insert(logs.begin(), dual(control.without_drift) - dual(control.chain));
                const DevelopmentChain related = with_related(controls, i);
                logs.push_back(
                    std::log(rmse_of(MotionDrift({}).correct(related.problem, report), related)) -
                    dual(control.chain));
                return std::pair{control.chain.name, logs};
              }));
}

}  // namespace
}  // namespace loopbench

int main(int argc, char** argv) {
  using namespace loopbench;
  if (argc > 2 || (argc == 2 && argv[1][0] == '-')) {
    const bool is_asked = argc == 2 && std::string(argv[1]) == "--help";
    fmt::print(is_asked ? stdout : stderr, "usage: motion_drift_study [DATA]\n");
    return is_asked ? 0 : 2;
  }
  try {
    if (argc == 2) {
      print_chains({{argv[1]}});
    } else {
      for (const double gain : {1.0, 0.25}) print_controls(gain);
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "motion_drift_study: {}\n", error.what());
    return 2;
  }
}
