#include "methods/correctors/motion_drift/variances.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace loopbench {
namespace {

using Factor = Eigen::LLT<Eigen::MatrixXd, Eigen::Lower>;

Factor covariance(const std::vector<VarianceComponent>& components, Eigen::Index size) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size, size);
  for (const VarianceComponent& c : components) {
    sum.triangularView<Eigen::Lower>() += c.value * c.share;
  }
  Factor factor(sum);
  if (factor.info() != Eigen::Success) {
    throw std::runtime_error("the covariance of the loop gaps is not positive definite");
  }
  return factor;
}

/// tr(A B) of two symmetric matrices, each known by its lower triangle.
double trace_of_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  double sum = 0.0;
  for (Eigen::Index column = 0; column < a.cols(); ++column) {
    const Eigen::Index below = a.rows() - column - 1;
    sum += a(column, column) * b(column, column) +
           2.0 * a.col(column).tail(below).dot(b.col(column).tail(below));
  }
  return sum;
}

/// The u where push e^u + pull e^-u + ((u + offset) / spread)^2 is smallest: convex, so Newton's
/// steps, kept below one, get there.
double smallest(double push, double pull, double offset, double spread) {
  const double stiffness = 2.0 / (spread * spread);
  double u = 0.0;
  for (int i = 0; i < 50; ++i) {
    const double up = push * std::exp(u);
    const double down = pull * std::exp(-u);
    const double step = -(up - down + stiffness * (u + offset)) / (up + down + stiffness);
    u += std::clamp(step, -1.0, 1.0);
    if (std::abs(step) < 1e-9) break;
  }
  return u;
}

double scale_of(const VarianceComponent& c, const std::vector<VarianceGroup>& groups) {
  return c.group < 0 ? 0.0 : groups[static_cast<std::size_t>(c.group)].log_scale;
}

}  // namespace

double log_evidence(const std::vector<VarianceComponent>& components, const Eigen::VectorXd& gap) {
  const Factor factor = covariance(components, gap.size());
  const double log_determinant = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
  return -0.5 * (gap.dot(factor.solve(gap)) + log_determinant +
                 static_cast<double>(gap.size()) * std::log(2.0 * std::numbers::pi));
}

double log_prior(const std::vector<VarianceComponent>& components,
                 const std::vector<VarianceGroup>& groups) {
  const auto density = [](double off, double spread) {
    return spread > 0.0 ? -0.5 * off * off / (spread * spread) : 0.0;
  };
  double sum = 0.0;
  for (const VarianceGroup& g : groups) sum += density(g.log_scale, g.spread);
  for (const VarianceComponent& c : components) {
    sum += density(std::log(c.value / c.prior) - scale_of(c, groups), c.spread);
  }
  return sum;
}

void fit(std::vector<VarianceComponent>& components,
         std::vector<VarianceGroup>& groups,
         const Eigen::VectorXd& gap,
         int iterations) {
  std::vector<double> push(components.size());
  std::vector<double> pull(components.size());
  for (int round = 0; round < iterations; ++round) {
    const Factor factor = covariance(components, gap.size());
    const Eigen::VectorXd alpha = factor.solve(gap);
    const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(gap.size(), gap.size()));
    for (std::size_t j = 0; j < components.size(); ++j) {
      const VarianceComponent& c = components[j];
      push[j] = c.value * trace_of_product(inverse, c.share);
      pull[j] = c.value * alpha.dot(c.share.selfadjointView<Eigen::Lower>() * alpha);
    }
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (groups[g].spread == 0.0) continue;
      double up = 0.0;
      double down = 0.0;
      for (std::size_t j = 0; j < components.size(); ++j) {
        if (components[j].group != static_cast<int>(g)) continue;
        up += push[j];
        down += pull[j];
      }
      const double u = smallest(up, down, groups[g].log_scale, groups[g].spread);
      groups[g].log_scale += u;
      for (std::size_t j = 0; j < components.size(); ++j) {
        if (components[j].group != static_cast<int>(g)) continue;
        components[j].value *= std::exp(u);
        push[j] *= std::exp(u);
        pull[j] *= std::exp(-u);
      }
    }
    for (std::size_t j = 0; j < components.size(); ++j) {
      VarianceComponent& c = components[j];
      if (c.spread == 0.0) continue;
      const double offset = std::log(c.value / c.prior) - scale_of(c, groups);
      c.value *= std::exp(smallest(push[j], pull[j], offset, c.spread));
    }
  }
}

}  // namespace loopbench
