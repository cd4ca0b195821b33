#include "tests/studies/drift_oracle.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "datasets/noise/random.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/correctors/scale_drift.hpp"
#include "methods/correctors/variance_components.hpp"
#include "metrics/alignment/alignment.hpp"

namespace loopbench {

using namespace methods;

namespace {

constexpr Eigen::Index kRates = 7;  ///< of translation, rotation and log scale

Trajectory integrated(const Problem& problem) {
  Trajectory out = problem.keyframes;
  double scale = 1.0;
  for (const Edge& edge : problem.odometry) {
    Pose step = edge.from_from_to;
    step.translation *= scale;
    out[edge.to].world_from_body = normalized(out[edge.from].world_from_body * step);
    scale *= edge.scale;
  }
  return out;
}

/// Errors of the keyframes after alignment, three rows each [m].
Eigen::VectorXd errors_of(const Trajectory& estimate, const DevelopmentChain& chain) {
  Trajectory known, reference;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    if (!chain.truth[i]) continue;
    known.push_back(estimate[i]);
    reference.push_back({estimate[i].stamp, *chain.truth[i]});
  }
  const auto type = has_scale_drift(chain.problem) ? metrics::Align::sim3 : metrics::Align::se3;
  known = metrics::moved(metrics::align(reference, known, type), known);
  Eigen::VectorXd out(3 * static_cast<Eigen::Index>(known.size()));
  for (std::size_t i = 0; i < known.size(); ++i) {
    out.segment<3>(3 * static_cast<Eigen::Index>(i)) =
        known[i].world_from_body.translation - reference[i].world_from_body.translation;
  }
  return out;
}

double rmse(const Eigen::VectorXd& errors) {
  return std::sqrt(3.0 * errors.squaredNorm() / static_cast<double>(errors.size()));
}

double cost_of(const Report& report) {
  const auto found = std::ranges::find(report.counts, "chi2", &Count::name);
  return found == report.counts.end() ? 0.0 : found->value;
}

void add_rates(Edge& edge, double by, const Eigen::VectorXd& rates) {
  const Twist error = by * rates.head<6>();
  edge.from_from_to = normalized(edge.from_from_to * exp_se3(error));
  edge.scale *= std::exp(by * rates[6]);
}

void add_gains(Edge& edge, const Eigen::VectorXd& gains) {
  const Vector3 rotation = log_so3(edge.from_from_to.rotation);
  edge.from_from_to.translation *= std::exp(gains[0]);
  const Vector3 added = rotation.cwiseProduct(gains.tail<3>());
  edge.from_from_to = normalized(edge.from_from_to * exp_se3(twist(Vector3::Zero(), added)));
}

class Oracle {
 public:
  Oracle(const DevelopmentChain& chain, OracleModel model) : chain_(chain), model_(model) {
    // A rate of one then changes the chain by one metre or radian in total.
    for (const Edge& edge : chain.problem.odometry) {
      const Eigen::Vector3d by = values(edge);
      total_ += by;
    }
  }

  /// Pattern search with steps from 2 % to 0.01 %.
  double error_of_least_cost() const {
    Eigen::VectorXd rates = Eigen::VectorXd::Zero(size());
    double least = corrected(rates).cost;
    for (double step = 0.02; step > 1e-4; step *= 0.5) {
      for (bool improved = true; improved;) {
        improved = false;
        for (Eigen::Index k = 0; k < size(); ++k) {
          for (const double by : {step, -step}) {
            Eigen::VectorXd trial = rates;
            trial[k] += by;
            const double cost = corrected(trial).cost;
            if (!(cost < least - 1e-6 * std::abs(least))) continue;
            least = cost;
            rates = trial;
            improved = true;
          }
        }
      }
    }
    return rmse(corrected(rates).errors);
  }

  double least_error() {
    Eigen::VectorXd rates = Eigen::VectorXd::Zero(size());
    Eigen::VectorXd errors = errors_at(rates);
    double damping = 1e-4;
    for (int iteration = 0; iteration < 30 && damping < 1e6; ++iteration) {
      Eigen::MatrixXd jacobian(errors.size(), size());
      for (Eigen::Index k = 0; k < size(); ++k) {
        Eigen::VectorXd moved = rates;
        moved[k] += kStep;
        jacobian.col(k) = (errors_at(moved) - errors) / kStep;
      }
      Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
      const double mean = normal.trace() / static_cast<double>(size());
      bool improved = false;
      double gained = 0.0;
      for (; !improved && damping < 1e6; damping *= improved ? 0.1 : 10.0) {
        Eigen::MatrixXd damped = normal;
        damped.diagonal().array() += damping * mean + 1e-12;
        const Eigen::VectorXd trial = rates - damped.ldlt().solve(jacobian.transpose() * errors);
        const Eigen::VectorXd at = errors_at(trial);
        improved = at.squaredNorm() < errors.squaredNorm();
        if (!improved) continue;
        gained = 1.0 - at.squaredNorm() / errors.squaredNorm();
        rates = trial;
        errors = at;
      }
      if (gained < 1e-6) break;
    }
    return rmse(errors);
  }

 private:
  static constexpr double kStep = 1e-4;

  bool uses(OracleModel part) const { return model_ == part || model_ == OracleModel::all; }

  Eigen::Index size() const {
    Eigen::Index out = uses(OracleModel::gains) ? 4 : 0;
    for (const auto part : {OracleModel::time, OracleModel::distance, OracleModel::rotation}) {
      out += uses(part) ? kRates : 0;
    }
    return out;
  }

  Eigen::Vector3d values(const Edge& edge) const {
    const Trajectory& keyframes = chain_.problem.keyframes;
    return {keyframes[edge.to].stamp - keyframes[edge.from].stamp,
            edge.from_from_to.translation.norm(),
            log_so3(edge.from_from_to.rotation).norm()};
  }

  struct Corrected {
    Eigen::VectorXd errors;
    double cost = 0.0;  ///< chi2 of odometry and loops, and a prior of 0.1 on each rate
  };

  Eigen::VectorXd errors_at(const Eigen::VectorXd& rates) const { return corrected(rates).errors; }

  Corrected corrected(const Eigen::VectorXd& rates) const {
    Problem problem = chain_.problem;
    const bool is_scaled = has_scale_drift(problem);
    for (Edge& edge : problem.odometry) {
      const Eigen::Vector3d by = values(edge).cwiseQuotient(total_);
      Eigen::Index at = 0;
      for (const auto part : {OracleModel::time, OracleModel::distance, OracleModel::rotation}) {
        if (!uses(part)) continue;
        Eigen::VectorXd own = rates.segment<kRates>(at);
        at += kRates;
        if (!is_scaled) own[6] = 0.0;
        if (problem.planar) own.segment<3>(2).setZero();
        add_rates(edge, by[static_cast<Eigen::Index>(part)], own);
      }
      if (!uses(OracleModel::gains)) continue;
      Eigen::VectorXd gains = rates.tail<4>();
      if (problem.planar) gains.segment<2>(1).setZero();
      add_gains(edge, gains);
    }
    problem.keyframes = integrated(problem);
    Report report;
    try {
      const Trajectory out = Dual({}).correct(problem, report);
      return {errors_of(out, chain_), cost_of(report) + rates.squaredNorm() / 0.01};
    } catch (const std::runtime_error&) {  // the rates are absurd
      const auto known =
          std::ranges::count_if(chain_.truth, [](const auto& pose) { return pose.has_value(); });
      return {Eigen::VectorXd::Constant(3 * known, 1e6), std::numeric_limits<double>::infinity()};
    }
  }

  const DevelopmentChain& chain_;
  OracleModel model_;
  Eigen::Vector3d total_ = Eigen::Vector3d::Constant(1e-12);
};

}  // namespace

double gains_from_loops_error(const DevelopmentChain& chain) {
  if (has_scale_drift(chain.problem)) return std::numeric_limits<double>::quiet_NaN();
  return Oracle(chain, OracleModel::gains).error_of_least_cost();
}

double aligned_error(const Trajectory& estimate, const DevelopmentChain& chain) {
  return rmse(errors_of(estimate, chain));
}

double oracle_error(const DevelopmentChain& chain, OracleModel model) {
  return Oracle(chain, model).least_error();
}

DevelopmentChain without_drift_control(const DevelopmentChain& chain, int seed) {
  Report report;
  DevelopmentChain out = chain;
  if (has_scale_drift(out.problem)) out.problem = remove_scale_drift(out.problem);
  const Trajectory truth = Dual({.scale = false}).correct(out.problem, report);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (chain.truth[i]) out.truth[i] = truth[i].world_from_body;
  }
  out.problem = with_factors(out.problem, variance_factors(out.problem));
  Random random({seed}, Purpose::odometry);
  for (std::vector<Edge>* edges : {&out.problem.odometry, &out.problem.closures}) {
    for (Edge& edge : *edges) {
      const Matrix6 deviations = edge.information.inverse().eval().llt().matrixL();
      const Vector3 translation = random.normal3(), rotation = random.normal3();
      Twist error = deviations * twist(translation, rotation);
      if (out.problem.planar) error.segment<3>(2).setZero();  // z, roll, pitch
      const Pose exact =
          truth[edge.from].world_from_body.inverse() * truth[edge.to].world_from_body;
      edge.from_from_to = normalized(exact * exp_se3(error));
      edge.scale = 1.0;
    }
  }
  out.problem.keyframes = integrated(out.problem);
  return out;
}

}  // namespace loopbench
