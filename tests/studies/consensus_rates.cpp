// Error rates of `consensus` and other correctors on chains with planted closures.
// Usage: consensus_rates DATA HALF METHODS [PLANT [DRAWS]]
// HALF: 0 design, 1 held out; METHODS: a,b,c; PLANT: a part of the names of plants, all by default;
// DRAWS: of each problem, 1 by default. step_known to step_share: see step_oracle.hpp
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "methods/correctors/consensus/judgement.hpp"
#include "methods/method.hpp"
#include "tests/studies/planted_problems.hpp"
#include "tests/studies/step_oracle.hpp"

namespace loopbench {
namespace {

using methods::Corrector;

double absolute_error(const Trajectory& keyframes, const Trajectory& truth) {
  Eigen::Matrix3Xd a(3, static_cast<Eigen::Index>(truth.size())), b = a;
  for (Eigen::Index i = 0; i < a.cols(); ++i) {
    a.col(i) = keyframes[static_cast<std::size_t>(i)].world_from_body.translation;
    b.col(i) = truth[static_cast<std::size_t>(i)].world_from_body.translation;
  }
  const Eigen::Matrix4d fit = Eigen::umeyama(a, b, false);
  const Eigen::Matrix3Xd fitted =
      (fit.topLeftCorner<3, 3>() * a).colwise() + Vector3(fit.topRightCorner<3, 1>());
  return std::sqrt((fitted - b).squaredNorm() / static_cast<double>(a.cols()));
}

struct Run {
  double ate = 0.0, seconds = 0.0;
  std::size_t kept_false = 0, dropped_true = 0;
  methods::Report report;
};

Run run(const std::string& name, const PlantedProblem& of, const TrueChain& chain) {
  const methods::Stage stage = methods::find_method(name).make({});
  const auto& corrector = std::get<std::unique_ptr<const Corrector>>(stage);
  Run out;
  const auto begin = std::chrono::steady_clock::now();
  Trajectory result = of.problem.keyframes;
  if (corrector->why_declined(of.problem).empty()) {
    result = corrector->correct(of.problem, out.report);
  }
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  out.ate = absolute_error(result, chain.truth);
  std::vector<bool> is_kept(of.is_false.size(), true);
  for (const std::size_t k : out.report.rejected.value_or(std::vector<std::size_t>{})) {
    is_kept[k] = false;
  }
  for (std::size_t k = 0; k < is_kept.size(); ++k) {
    out.kept_false += is_kept[k] && of.is_false[k] ? 1 : 0;
    out.dropped_true += !is_kept[k] && !of.is_false[k] ? 1 : 0;
  }
  return out;
}

double count_of(const methods::Report& report, const std::string& name) {
  for (const methods::Count& count : report.counts) {
    if (count.name == name) return count.value;
  }
  return 0.0;
}

/// The steps that consensus accuses, as "50x100;60xinf".
std::string accused(const Problem& problem) {
  if (!methods::why_not_judged(problem).empty()) return "";
  std::string out;
  for (const methods::FreedStep& step : methods::judge_closures(problem).steps) {
    out += fmt::format("{}{}x{}", out.empty() ? "" : ";", step.from, step.inflation);
  }
  return out;
}

/// What an oracle sees of the wrong step: its log odds with known and with fitted factors, the most
/// probable step, and the share of the wrong one; empty without a wrong step.
std::string seen_by_oracle(const TrueChain& chain, const PlantedProblem& of) {
  if (!of.wrong_step) return ",,,";
  const StepOracle seen = step_oracle(chain, of);
  return fmt::format("{:.4g},{:.4g},{},{:.3g}",
                     seen.with_known_factors,
                     seen.with_fitted_factors,
                     seen.best_step,
                     seen.share);
}

/// The true closures, steps and deviations.
double oracle(const TrueChain& chain, const PlantedProblem& of) {
  PlantedProblem known = of;
  known.problem.odometry = chain.problem.odometry;
  if (of.wrong_step) {
    std::erase_if(known.problem.odometry, [&](const Edge& e) { return e.from == *of.wrong_step; });
  }
  known.problem.closures.clear();
  for (std::size_t k = 0; k < of.is_false.size(); ++k) {
    if (!of.is_false[k]) known.problem.closures.push_back(of.problem.closures[k]);
  }
  known.is_false.assign(known.problem.closures.size(), false);
  return run("pose_graph", known, chain).ate;
}

/// One row for each factor on the odometry's deviations and each method.
void print_rows(const TrueChain& chain,
                Plant plant,
                int draw,
                const std::vector<std::string>& names) {
  std::string seen;  // it does not depend on the factor
  for (const double odometry : {0.1, 1.0, 10.0}) {
    const PlantedProblem problem = planted(chain, plant, odometry, draw);
    const auto falses = std::ranges::count(problem.is_false, true);
    const double raw = absolute_error(problem.problem.keyframes, chain.truth);
    const double known = oracle(chain, problem);
    if (seen.empty()) seen = seen_by_oracle(chain, problem);
    for (const std::string& name : names) {
      const Run done = run(name, problem, chain);
      fmt::print(
          "{},{},{},{},{:.5g},{:.5g},{:.5g},{},{},{},{},{:.4f},{},{:.3g},{:.3g},{:.3g},"
          "{:.3g},{:.3g},{},{},{},{}\n",
          chain.name,
          name_of(plant),
          odometry,
          name,
          done.ate,
          raw,
          known,
          std::ssize(problem.is_false) - falses,
          falses,
          done.kept_false,
          done.dropped_true,
          done.seconds,
          count_of(done.report, "decided"),
          count_of(done.report, "factor_t"),
          count_of(done.report, "factor_r"),
          count_of(done.report, "factor_closures"),
          count_of(done.report, "evidence"),
          count_of(done.report, "rival_evidence"),
          problem.wrong_step ? std::to_string(*problem.wrong_step) : "",
          name == "consensus" ? accused(problem.problem) : "",
          draw,
          seen);
    }
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace loopbench

int main(int argc, char** argv) {
  using namespace loopbench;
  if (argc < 4 || argc > 6) {
    fmt::print(stderr, "usage: consensus_rates DATA HALF METHODS [PLANT [DRAWS]]\n");
    return 2;
  }
  const int half = std::atoi(argv[2]);
  const int draws = argc == 6 ? std::atoi(argv[5]) : 1;
  std::vector<std::string> names;
  std::istringstream given(argv[3]);
  for (std::string name; std::getline(given, name, ',');) names.push_back(name);
  std::vector<TrueChain> chains = recorded_chains(argv[1]);
  for (TrueChain& each : simulated_chains(1, 12)) chains.push_back(std::move(each));
  fmt::print(
      "chain,plant,odometry,method,ate,raw,oracle,true,false,kept_false,dropped_true,"
      "seconds,decided,factor_t,factor_r,factor_closures,evidence,rival,wrong_step,accused,"
      "draw,step_known,step_fitted,step_best,step_share\n");
  for (std::size_t c = 0; c < chains.size(); ++c) {
    if (static_cast<int>(c % 2) != half) continue;
    const TrueChain with_bias = biased(chains[c]);
    for (int plant = 0; plant <= static_cast<int>(kLastPlant); ++plant) {
      if (argc > 4 && name_of(static_cast<Plant>(plant)).find(argv[4]) == std::string::npos) {
        continue;
      }
      const TrueChain& chain = is_biased(static_cast<Plant>(plant)) ? with_bias : chains[c];
      for (int draw = 1; draw <= draws; ++draw) {
        print_rows(chain, static_cast<Plant>(plant), draw, names);
      }
    }
  }
}
