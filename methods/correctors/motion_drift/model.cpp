#include "methods/correctors/motion_drift/model.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace loopbench::methods {
namespace {

/// For each odometry edge, whether at least one loop encloses it.
std::vector<bool> enclosed_edges(const Problem& problem) {
  std::vector<int> change(problem.odometry.size() + 1, 0);
  for (const Edge& loop : problem.closures) {
    ++change[loop.from];
    --change[loop.to];
  }
  std::vector<bool> out;
  int loops = 0;
  for (std::size_t i = 0; i < problem.odometry.size(); ++i) {
    loops += change[i];
    out.push_back(loops > 0);
  }
  return out;
}

/// Computes the part of each edge that lies within `reach` of the last enclosed edge. `edges` lists
/// the edge indices forwards or backwards along the chain; `of` returns the regressor of an edge.
template <class Edges, class Of>
void reach_along(const Edges& edges,
                 const std::vector<bool>& enclosed,
                 double reach,
                 Of of,
                 std::vector<double>& part) {
  double remaining = 0.0;
  for (const std::size_t i : edges) {
    if (enclosed[i]) {
      part[i] = 1.0;
      remaining = reach;
      continue;
    }
    const double along = of(i);
    if (remaining > 0.0) part[i] = std::max(part[i], along > remaining ? remaining / along : 1.0);
    remaining -= along;
  }
}

/// Lower bound on each edge's variance, as a fraction of the chain's mean variance. An edge without
/// motion would otherwise have a singular covariance.
constexpr double kFloor = 1e-9;

void add_odometry(NoiseModel& noise_model,
                  const MotionModel& model,
                  const Problem& problem,
                  const std::vector<EdgeMotion>& motions) {
  noise_model.covariance.assign(motions.size(), Matrix6::Zero());
  for (const Term& term : model) {
    for (std::size_t i = 0; i < motions.size(); ++i) {
      if (term.kind == TermKind::noise) {
        const double variance = term.value * regressor_value(term.regressor, motions[i]);
        noise_model.covariance[i].diagonal() += on_axes(term, Twist::Constant(variance));
      } else if (term.kind == TermKind::stated) {
        noise_model.covariance[i] += term.value * problem.odometry[i].information.inverse();
      }
    }
  }
  Twist mean = Twist::Zero();
  for (const Matrix6& c : noise_model.covariance) {
    mean += c.diagonal() / static_cast<double>(motions.size());
  }
  for (Matrix6& c : noise_model.covariance) {
    c.diagonal() = c.diagonal().cwiseMax(kFloor * mean);
    noise_model.information.push_back(c.inverse());
  }
}

}  // namespace

void limit_drift(std::vector<EdgeMotion>& motions, const Problem& problem, double reach) {
  const std::vector<bool> enclosed = enclosed_edges(problem);
  std::vector<std::size_t> forwards(motions.size());
  for (std::size_t i = 0; i < forwards.size(); ++i) forwards[i] = i;
  const std::vector<std::size_t> backwards(forwards.rbegin(), forwards.rend());
  for (const Regressor regressor : kRegressors) {
    const auto along = [&](std::size_t i) { return regressor_value(regressor, motions[i]); };
    double covered = 0.0;
    for (const std::size_t i : forwards) covered += enclosed[i] ? along(i) : 0.0;
    std::vector<double> part(motions.size(), 0.0);
    reach_along(forwards, enclosed, reach * covered, along, part);
    reach_along(backwards, enclosed, reach * covered, along, part);
    for (const std::size_t i : forwards) {
      motions[i].drift_part[static_cast<std::size_t>(regressor)] = part[i];
    }
  }
}

Twist on_axes(const Term& term, const Twist& all) {
  Twist out = Twist::Zero();
  const Eigen::Index at = term.component == Component::translation ? 0 : 3;
  if (term.axis < 0) {
    out.segment<3>(at) = all.segment<3>(at);
  } else {
    out[at + term.axis] = all[at + term.axis];
  }
  return out;
}

std::string name_of(const Term& term) {
  const std::string component = term.component == Component::translation ? "t" : "r";
  if (term.kind == TermKind::closures) return "closures." + component;
  if (term.kind == TermKind::stated) return "stated";
  const std::string kind = term.kind == TermKind::noise ? "noise." : "drift.";
  static constexpr const char* kAxes[] = {"", ".x", ".y", ".z"};
  return kind + component + ".per_" + name_of(term.regressor) + kAxes[term.axis + 1];
}

NoiseModel noise_model_of(const MotionModel& model,
                          const Problem& problem,
                          const std::vector<EdgeMotion>& motions) {
  NoiseModel out;
  add_odometry(out, model, problem, motions);
  Twist scale = Twist::Ones();  // factor on the closures' standard deviations
  for (const Term& term : model) {
    if (term.kind != TermKind::closures) continue;
    const double deviation = std::sqrt(term.value);
    (term.component == Component::translation ? scale.head<3>() : scale.tail<3>())
        .setConstant(deviation);
  }
  for (const Edge& loop : problem.closures) {
    const Twist inverse_scale = scale.cwiseInverse();
    out.closure_covariance.push_back(scale.asDiagonal() * loop.information.inverse() *
                                     scale.asDiagonal());
    out.closure_information.push_back(inverse_scale.asDiagonal() * loop.information *
                                      inverse_scale.asDiagonal());
  }
  for (const Regressor regressor : kRegressors) {
    Twist rates = Twist::Zero();
    for (const Term& term : model) {
      if (term.kind == TermKind::drift && term.regressor == regressor)
        rates += on_axes(term, Twist::Constant(term.value));
    }
    if (rates.isZero(0.0)) continue;
    NoiseModel::Drift drift{{}, rates};
    drift.shape.reserve(motions.size());
    for (const EdgeMotion& motion : motions) {
      drift.shape.push_back(Twist::Constant(drift_regressor_value(regressor, motion)));
    }
    out.drift.push_back(std::move(drift));
  }
  return out;
}

}  // namespace loopbench::methods
