#include "methods/correctors/motion_drift/motion_drift.hpp"

#include <algorithm>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/motion_drift/evidence.hpp"

namespace loopbench {
namespace {

using Model = MotionDrift::Model;

bool has(Model model, Cause cause, Half half, Growth growth) {
  if (cause == Cause::drift) {
    if (model != Model::drift) return false;
    return half == Half::translation
               ? growth == Growth::distance
               : growth == Growth::time || growth == Growth::distance || growth == Growth::rotation;
  }
  switch (growth) {
    case Growth::edge:
      return model == Model::constant;
    case Growth::time:
      return model >= Model::time;
    case Growth::distance:
      return model >= Model::distance;
    case Growth::rotation:
      return model >= Model::rotation;
    case Growth::speed:
      return model == Model::speed;
  }
  return false;
}

MotionModel model_of(const MotionDrift::Options& o) {
  MotionModel out;
  for (const Cause cause : {Cause::noise, Cause::drift}) {
    for (const Half half : {Half::translation, Half::rotation}) {
      for (const Growth growth : kGrowths) {
        const auto& values =
            (cause == Cause::noise ? o.noise : o.drift)[static_cast<std::size_t>(half)];
        const std::optional<double>& given = values[static_cast<std::size_t>(growth)];
        if (given ? *given == 0.0 : !has(o.model, cause, half, growth)) continue;
        const double value = given.value_or(0.0);
        out.push_back({cause,
                       half,
                       growth,
                       cause == Cause::drift ? value * value : value,
                       given.has_value()});
      }
    }
  }
  for (const Half half : {Half::translation, Half::rotation}) {
    const std::optional<double>& given = o.closures[static_cast<std::size_t>(half)];
    out.push_back({Cause::closures, half, Growth::edge, given.value_or(1.0), given.has_value()});
  }
  return out;
}

/// At most `most` of 0 .. size - 1, evenly.
std::vector<std::size_t> spread_choice(std::size_t size, std::size_t most) {
  std::vector<std::size_t> out;
  const std::size_t count = std::min(size, most);
  for (std::size_t i = 0; i < count; ++i) out.push_back(i * size / count);
  return out;
}

constexpr int kFitIterations = 30;  // a round; what is left is a small part of the spreads

}  // namespace

std::optional<std::string> MotionDrift::declines(const Problem& problem) const {
  if (problem.closures.empty()) return "no loop closure to spread";
  if (problem.closures.size() > static_cast<std::size_t>(options_.max_closures)) {
    return std::to_string(problem.closures.size()) +
           " closures, more than max_closures = " + std::to_string(options_.max_closures);
  }
  if (const std::string fault = chain_fault(problem); !fault.empty()) return fault;
  return std::nullopt;
}

Trajectory MotionDrift::correct(const Problem& problem, Report& report) const {
  const std::vector<EdgeMotion> moved = motions(problem);
  LoopedChain chain(problem, stated_belief(problem));
  MotionModel model = model_of(options_);
  guess(model, options_.guess, problem, moved, chain.linearised().gap);
  std::erase_if(model, [](const Term& term) { return term.value == 0.0; });
  if (options_.fit) report.count("log_evidence", fit_to_loops(model, chain, problem, moved));

  chain.believe(belief_of(model, problem, moved));
  int iterations = 0;
  while (iterations < options_.max_iterations) {
    const double before = chain.cost();
    if (!chain.step()) break;
    ++iterations;
    if (before - chain.cost() <= options_.tolerance * before) break;
  }
  report.count("iterations", iterations);
  report.count("cost", chain.cost());
  for (const Term& term : model) report.count(name_of(term), term.value);
  return chain.keyframes();
}

double MotionDrift::fit_to_loops(MotionModel& model,
                                 LoopedChain& chain,
                                 const Problem& problem,
                                 const std::vector<EdgeMotion>& moved) const {
  const MotionModel prior = model;
  const auto used =
      spread_choice(problem.closures.size(), static_cast<std::size_t>(options_.fit_closures));
  std::vector<VarianceGroup> halves(2, {0.0, options_.scale_spread});
  double evidence_then = 0.0;
  for (int round = 0; round < options_.fit_rounds; ++round) {
    const Evidence evidence = evidence_of(model, chain, problem, moved, used);
    std::vector<VarianceComponent> components;
    for (std::size_t j = 0; j < model.size(); ++j) {
      const bool closures = model[j].cause == Cause::closures;
      components.push_back({evidence.shares[j],
                            model[j].value,
                            prior[j].value,
                            closures ? options_.closures_spread : options_.share_spread,
                            closures ? -1 : static_cast<int>(model[j].half)});
    }
    fit(components, halves, evidence.gap, kFitIterations);
    for (std::size_t j = 0; j < model.size(); ++j) model[j].value = components[j].value;
    evidence_then = log_evidence(components, evidence.gap);
    chain.believe(belief_of(model, problem, moved));
    chain.step();
  }
  return evidence_then;
}

}  // namespace loopbench
