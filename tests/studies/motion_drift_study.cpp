// Errors of motion_drift relative to those of dual:
//   motion_drift_study DATA > chains.md    development chains, complete and in sections
//   motion_drift_study > controls.md       simulated controls with known drift, 50 seeds each
//   motion_drift_study DATA oracle         errors left if rates of drift, or closures, were exact
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <utility>

#include "datasets/core/parallel.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/correctors/motion_drift/motion_drift.hpp"
#include "tests/studies/development_chains.hpp"
#include "tests/studies/drift_controls.hpp"
#include "tests/studies/drift_oracle.hpp"
#include "tests/studies/target_chains.hpp"

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

/// What fitting the rates gains where there is no drift: median ratio of the oracle's error to that
/// of `dual` on copies of the chain without drift, and the number of copies with less than `ratio`.
std::string chance(const DevelopmentChain& chain, OracleModel model, double ratio) {
  constexpr std::size_t kSeeds = 20;
  const auto copies = computed(kSeeds, [&](std::size_t seed) {
    const DevelopmentChain copy = without_drift_control(chain, static_cast<int>(seed) + 1);
    Report report;
    const double dual = rmse_of(Dual({}).correct(copy.problem, report), copy);
    return std::pair{std::string(), std::vector{oracle_error(copy, model) / dual}};
  });
  std::vector<double> ratios;
  for (const auto& [name, values] : copies) ratios.push_back(values.front());
  std::ranges::sort(ratios);
  const auto below = std::ranges::lower_bound(ratios, ratio) - ratios.begin();
  return fmt::format("{:.2f} ({})", ratios[kSeeds / 2], below);
}

/// Two rows: errors [m], and the gain of the oracle by chance.
void print_oracle(const DevelopmentChain& chain, bool is_target) {
  Report report;
  const auto error = [&](const Corrector& method, const DevelopmentChain& of) {
    return aligned_error(method.correct(of.problem, report), of);
  };
  const double dual = error(Dual({}), chain);
  fmt::print("| {} | {:.4f} | {:.4f} | {:.4f} | {:.4f} | {:.4f} |",
             chain.name,
             dual,
             error(Dual({.rescale = true}), chain),
             error(MotionDrift({}), chain),
             gains_from_loops_error(chain),
             error(Dual({}), with_exact_closures(chain)));
  const auto errors = computed(kOracleModels.size(), [&](std::size_t i) {
    return std::pair{std::string(), std::vector{oracle_error(chain, kOracleModels[i])}};
  });
  for (const auto& [name, values] : errors) fmt::print(" {:.4f} |", values.front());
  fmt::print("\n| ratio without drift | 1 | | | | |");
  for (std::size_t i = 0; i < kOracleModels.size(); ++i) {
    const bool is_computed = is_target || kOracleModels[i] == OracleModel::gains;
    fmt::print(" {} |",
               is_computed ? chance(chain, kOracleModels[i], errors[i].second.front() / dual) : "");
  }
  fmt::print("\n");
  std::fflush(stdout);
}

void print_oracles(const DataRoot& root) {
  fmt::print(
      "| chain | dual | dual rescaled | motion_drift | gains from loops | exact closures | time | "
      "distance | "
      "rotation | gains | all |\n| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | "
      "---: | ---: |\n");
  for (const DevelopmentChain& chain : target_chains(root)) print_oracle(chain, true);
  const std::vector<DevelopmentChain> chains = development_chains(root);
  for (const DevelopmentChain& chain : chains) {
    const bool is_complete = chain.name.find("loops") != std::string::npos;
    if (chain.odometer == "INTEL" && is_complete) print_oracle(chain, false);
  }
  fmt::print("\n");
  print_table("odometer", {"gains from loops"}, computed(chains.size(), [&](std::size_t i) {
                Report report;
                const double dual = rmse_of(Dual({}).correct(chains[i].problem, report), chains[i]);
                return std::pair{chains[i].odometer,
                                 std::vector{std::log(gains_from_loops_error(chains[i]) / dual)}};
              }));
}

}  // namespace
}  // namespace loopbench

int main(int argc, char** argv) {
  using namespace loopbench;
  const bool is_oracle = argc == 3 && std::string(argv[2]) == "oracle";
  if ((argc > 2 && !is_oracle) || (argc == 2 && argv[1][0] == '-')) {
    const bool is_asked = argc == 2 && std::string(argv[1]) == "--help";
    fmt::print(is_asked ? stdout : stderr, "usage: motion_drift_study [DATA [oracle]]\n");
    return is_asked ? 0 : 2;
  }
  try {
    if (is_oracle) {
      print_oracles({{argv[1]}});
    } else if (argc == 2) {
      print_chains({{argv[1]}});
    } else {
      for (const double gain : {1.0, 0.25}) print_controls(gain);
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "motion_drift_study: {}\n", error.what());
    return 2;
  }
}
