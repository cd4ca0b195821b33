#include "harness/calibrate/rates.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "datasets/core/error.hpp"

namespace loopbench::harness {
namespace {

std::vector<Eigen::Index> axes(methods::Component component, bool planar) {
  if (component == methods::Component::translation) {
    return planar ? std::vector<Eigen::Index>{0, 1} : std::vector<Eigen::Index>{0, 1, 2};
  }
  return planar ? std::vector<Eigen::Index>{5} : std::vector<Eigen::Index>{3, 4, 5};
}

/// One sequence as arrays: regressors of noise and of drift, and the errors of each axis.
struct Design {
  Eigen::MatrixXd noise;
  Eigen::MatrixXd drift;
  Eigen::MatrixXd errors;
};

Design design(const Rates& rates, const CalibrationResiduals& sequence) {
  const auto n = static_cast<Eigen::Index>(sequence.edges.size());
  const auto on = axes(rates.component, sequence.planar);
  Design out{Eigen::MatrixXd(n, static_cast<Eigen::Index>(rates.noise.size())),
             Eigen::MatrixXd(n, static_cast<Eigen::Index>(rates.drift.size())),
             Eigen::MatrixXd(n, static_cast<Eigen::Index>(on.size()))};
  for (Eigen::Index i = 0; i < n; ++i) {
    const EdgeError& edge = sequence.edges[static_cast<std::size_t>(i)];
    const auto fill = [&](Eigen::MatrixXd& matrix, const std::vector<methods::Regressor>& terms) {
      for (std::size_t j = 0; j < terms.size(); ++j) {
        matrix(i, static_cast<Eigen::Index>(j)) =
            edge.regressors[static_cast<std::size_t>(terms[j])];
      }
    };
    fill(out.noise, rates.noise);
    fill(out.drift, rates.drift);
    for (std::size_t a = 0; a < on.size(); ++a) {
      out.errors(i, static_cast<Eigen::Index>(a)) = edge.error[on[a]];
    }
  }
  return out;
}

Eigen::VectorXd vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// C = D + F F', D diagonal, F = phi_drift sqrt(v): inverted through the small matrix I + F' D^-1
/// F.
struct Inverted {
  Eigen::ArrayXd weights;  ///< D^-1
  Eigen::MatrixXd F;
  Eigen::LLT<Eigen::MatrixXd> small;

  Inverted(const Rates& rates, const Design& d)
      : F(d.drift * vector(rates.drift_variance).cwiseSqrt().asDiagonal()) {
    const Eigen::ArrayXd variance = (d.noise * vector(rates.noise_variance)).array();
    // An edge without motion has zero noise in some models, so its error would be infinitely
    // unlikely.
    weights = variance.max(1e-9 * variance.mean()).inverse();
    small.compute(Eigen::MatrixXd::Identity(F.cols(), F.cols()) +
                  F.transpose() * weights.matrix().asDiagonal() * F);
  }

  Eigen::MatrixXd times(const Eigen::MatrixXd& right) const {
    const Eigen::MatrixXd weighted = weights.matrix().asDiagonal() * right;
    return weighted - weights.matrix().asDiagonal() * (F * small.solve(F.transpose() * weighted));
  }

  Eigen::ArrayXd diagonal() const {
    const Eigen::MatrixXd whitened = small.matrixL().solve(F.transpose());
    return weights - weights.square() * whitened.colwise().squaredNorm().transpose().array();
  }

  double log_determinant() const {
    return 2.0 * small.matrixLLT().diagonal().array().log().sum() - weights.log().sum();
  }
};

std::vector<Design> designs(const Rates& rates,
                            const std::vector<CalibrationResiduals>& sequences) {
  std::vector<Design> out;
  for (const CalibrationResiduals& sequence : sequences) out.push_back(design(rates, sequence));
  return out;
}

}  // namespace

double count(methods::Component component, const std::vector<CalibrationResiduals>& sequences) {
  double out = 0.0;
  for (const CalibrationResiduals& s : sequences) {
    out += static_cast<double>(s.edges.size() * axes(component, s.planar).size());
  }
  return out;
}

double log_likelihood(const Rates& rates, const std::vector<CalibrationResiduals>& sequences) {
  double sum = 0.0;
  for (const Design& d : designs(rates, sequences)) {
    const Inverted C(rates, d);
    sum += d.errors.cwiseProduct(C.times(d.errors)).sum() +
           static_cast<double>(d.errors.cols()) *
               (C.log_determinant() +
                static_cast<double>(d.errors.rows()) * std::log(2.0 * std::numbers::pi));
  }
  return -0.5 * sum;
}

Rates fit_rates(methods::Component component,
                const std::vector<methods::Regressor>& noise,
                const std::vector<methods::Regressor>& drift,
                const std::vector<CalibrationResiduals>& sequences,
                int iterations) {
  Rates out{component, noise, drift, {}, {}};
  const std::vector<Design> all = designs(out, sequences);
  double squares = 0.0;
  for (const Design& d : all) squares += d.errors.squaredNorm();
  if (!(squares > 0.0)) throw InputError("calibrate: all edges have zero error");
  squares /= count(component, sequences);
  // Start with equal contributions of every term to the mean square.
  const auto start = [&](const Eigen::MatrixXd Design::*part, Eigen::Index j, int power) {
    double sum = 0.0;
    double edges = 0.0;
    for (const Design& d : all) {
      sum += (d.*part).col(j).array().pow(power).sum();
      edges += static_cast<double>(d.errors.rows());
    }
    const double terms = static_cast<double>(noise.size() + drift.size());
    return sum > 0.0 ? squares * edges / (terms * sum) : 0.0;
  };
  for (std::size_t j = 0; j < noise.size(); ++j) {
    out.noise_variance.push_back(start(&Design::noise, static_cast<Eigen::Index>(j), 1));
  }
  for (std::size_t j = 0; j < drift.size(); ++j) {
    out.drift_variance.push_back(start(&Design::drift, static_cast<Eigen::Index>(j), 2));
  }

  const auto terms_n = static_cast<Eigen::Index>(noise.size());
  const auto terms_d = static_cast<Eigen::Index>(drift.size());
  for (int round = 0; round < iterations; ++round) {
    Eigen::ArrayXd push = Eigen::ArrayXd::Zero(terms_n + terms_d);
    Eigen::ArrayXd pull = push;
    for (const Design& d : all) {
      const Inverted C(out, d);
      const auto on = static_cast<double>(d.errors.cols());
      const Eigen::MatrixXd alpha = C.times(d.errors);
      push.head(terms_n) += on * (d.noise.transpose() * C.diagonal().matrix()).array();
      pull.head(terms_n) += (d.noise.transpose() * alpha.rowwise().squaredNorm().matrix()).array();
      if (terms_d == 0) continue;
      push.tail(terms_d) +=
          on * d.drift.cwiseProduct(C.times(d.drift)).colwise().sum().transpose().array();
      pull.tail(terms_d) += (d.drift.transpose() * alpha).rowwise().squaredNorm().array();
    }
    const auto update = [&](std::vector<double>& values, Eigen::Index from) {
      for (std::size_t j = 0; j < values.size(); ++j) {
        const Eigen::Index at = from + static_cast<Eigen::Index>(j);
        if (push[at] > 0.0) values[j] *= std::sqrt(pull[at] / push[at]);
      }
    };
    update(out.noise_variance, 0);
    update(out.drift_variance, terms_n);
  }
  return out;
}

}  // namespace loopbench::harness
