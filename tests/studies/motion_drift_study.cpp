// Errors of motion_drift on the development chains under several settings, and cross-validation of
// the settings with one sequence, or one odometer, left out:
//   motion_drift_study DATA > table.md
#include <fmt/format.h>

#include <atomic>
#include <cmath>

#include "datasets/core/parallel.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/correctors/motion_drift/motion_drift.hpp"
#include "tests/studies/development_chains.hpp"
#include "tests/studies/left_out.hpp"

namespace loopbench {

using namespace methods;

namespace {

struct Setting {
  std::string name;
  Params options;
};

Params chances(double as_stated, double scaled, double steady) {
  return {{"prior.as_stated_probability", as_stated},
          {"prior.scaled_probability", scaled},
          {"prior.drift_probability", steady}};
}

/// Settings in the table, each an earlier version of the method.
std::vector<Setting> forms() {
  return {{"free, drift", chances(0.0, 0.0, 1.0)},
          {"free, drift or none", chances(0.0, 0.0, 0.3)},
          {"0.3 for drift", chances(0.5, 0.25, 0.3)},
          {"current", {}}};
}

/// Candidates of the cross-validation.
std::vector<Setting> candidates() {
  std::vector<Setting> out = forms();
  out.resize(2);
  for (const double steady : {0.3, 0.5, 0.7, 0.85}) {
    for (const double as_stated : {0.3, 0.5, 0.7}) {
      out.push_back({fmt::format("drift {}, as stated {}", steady, as_stated),
                     chances(as_stated, 0.25, steady)});
    }
  }
  return out;
}

/// log(ATE / ATE of dual): one row per chain, one column per setting.
std::vector<std::vector<double>> log_ratios(const std::vector<DevelopmentChain>& chains,
                                            const std::vector<Setting>& settings) {
  std::vector<std::vector<double>> out(chains.size());
  std::atomic<std::size_t> next{0};
  parallel_invoke(hardware_threads(), [&](std::size_t) {
    for (std::size_t i = next++; i < chains.size(); i = next++) {
      Report report;
      const double stated = rmse_of(Dual({}).correct(chains[i].problem, report), chains[i]);
      for (const Setting& setting : settings) {
        const MotionDrift method(with(MotionDrift::Options{}, setting.options));
        const double ours = rmse_of(method.correct(chains[i].problem, report), chains[i]);
        out[i].push_back(std::log(ours / stated));
      }
    }
  });
  return out;
}

enum class Part { sequence, odometer };

std::vector<GroupRatios> grouped(const std::vector<DevelopmentChain>& chains,
                                 const std::vector<std::vector<double>>& logs,
                                 Part part) {
  std::vector<GroupRatios> out;
  for (std::size_t i = 0; i < chains.size(); ++i) {
    const DevelopmentChain& chain = chains[i];
    if (out.empty() || out.back().group != chain.odometer) {
      out.push_back({chain.odometer, part == Part::sequence ? chain.sequence : chain.odometer, {}});
    }
    out.back().logs.push_back(logs[i]);
  }
  return out;
}

/// "0.83 (1.43; 15)": geometric mean, worst, number above 1.05.
std::string cell(const std::vector<GroupRatios>& groups, std::size_t setting) {
  double mean = 0.0, worst = 0.0;
  int above = 0;
  for (const GroupRatios& group : groups) {
    mean += mean_log(group, setting) / static_cast<double>(groups.size());
    for (const auto& chain : group.logs) {
      worst = std::max(worst, std::exp(chain[setting]));
      above += std::exp(chain[setting]) > 1.05;
    }
  }
  return fmt::format("{:.2f} ({:.2f}; {})", std::exp(mean), worst, above);
}

void print_forms(const std::vector<DevelopmentChain>& chains) {
  const std::vector<Setting> settings = forms();
  const auto groups = grouped(chains, log_ratios(chains, settings), Part::odometer);
  fmt::print("| odometer | chains |");
  for (const Setting& setting : settings) fmt::print(" {} |", setting.name);
  fmt::print("\n| --- | ---: |");
  for (std::size_t s = 0; s < settings.size(); ++s) fmt::print(" ---: |");
  const auto row = [&](const std::string& name, const std::vector<GroupRatios>& of) {
    std::size_t count = 0;
    for (const GroupRatios& group : of) count += group.logs.size();
    fmt::print("\n| {} | {} |", name, count);
    for (std::size_t s = 0; s < settings.size(); ++s) fmt::print(" {} |", cell(of, s));
  };
  for (const GroupRatios& group : groups) row(group.group, {group});
  row("all", groups);
  fmt::print("\n\n");
}

void print_left_out(const std::vector<DevelopmentChain>& chains) {
  const std::vector<Setting> settings = candidates();
  const auto logs = log_ratios(chains, settings);
  for (const Part part : {Part::sequence, Part::odometer}) {
    const auto groups = grouped(chains, logs, part);
    const LeftOutEstimate found = left_out(groups);
    fmt::print("One {} left out: {:.3f} [{:.3f}, {:.3f}], worst {:.2f}, {} of {} above 1.05\n",
               part == Part::sequence ? "sequence" : "odometer",
               found.ratio,
               found.low,
               found.high,
               found.worst,
               found.above,
               chains.size());
    for (std::size_t g = 0; g < groups.size(); ++g) {
      fmt::print("- {}: {}\n", groups[g].group, settings[found.chosen[g]].name);
    }
  }
}

}  // namespace
}  // namespace loopbench

int main(int argc, char** argv) {
  using namespace loopbench;
  if (argc != 2 || argv[1][0] == '-') {
    const bool is_asked = argc == 2 && std::string(argv[1]) == "--help";
    fmt::print(is_asked ? stdout : stderr, "usage: motion_drift_study DATA\n");
    return is_asked ? 0 : 2;
  }
  try {
    const auto chains = development_chains({{argv[1]}});
    print_forms(chains);
    print_left_out(chains);
  } catch (const std::exception& error) {
    fmt::print(stderr, "motion_drift_study: {}\n", error.what());
    return 2;
  }
}
