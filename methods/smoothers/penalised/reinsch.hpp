/// Natural cubic smoothing spline for one value of lambda.
#pragma once

#include <vector>

#include "methods/smoothers/penalised/slope_change.hpp"

namespace loopbench::methods {

/// Minimises sum |y_i - f(t_i)|^2 + lambda int |f''|^2. With Q = D' (slope_change.hpp) and R the
/// tridiagonal Gram matrix of the hat functions,
///
///     (R + lambda Q'Q) gamma = Q'y,   f(t_i) = y_i - lambda (Q gamma)_i,   f''(t_i) = gamma_i.
///
/// lambda -> 0 interpolates, lambda -> infinity gives the regression line. O(n).
/// Source: Reinsch 1967; Green & Silverman 1994, ch. 2; Hutchinson & de Hoog 1985 for the trace.
class Reinsch {
 public:
  struct Fit {
    std::vector<Vector3> values;   ///< f at the stamps
    std::vector<Vector3> bends;    ///< f'' at the stamps, zero at both ends
    double free = 0.0;             ///< tr(I - A), residual degrees of freedom per axis
    Vector3 residual;              ///< y' (I - A)^2 y per axis
    Vector3 energy;                ///< y' (I - A) y per axis
    double log_determinant = 0.0;  ///< of I - A on its range, up to a constant of the stamps
  };

  /// Requires at least three strictly increasing stamps.
  explicit Reinsch(const std::vector<double>& stamps);

  /// Fits y with lambda > 0 [s^3]. A is the matrix with values = A y.
  Fit fit(const std::vector<Vector3>& y, double lambda) const;

 private:
  SlopeChange slope_change_;
  Pentadiagonal gram_;   ///< R
  Pentadiagonal outer_;  ///< Q'Q
};

/// Selection criterion of lambda.
enum class Criterion {
  gcv,   ///< n |(I - A) y|^2 / tr(I - A)^2 (Craven & Wahba 1979)
  reml,  ///< restricted maximum likelihood: (n - 2) log y'(I - A)y - log det+ (I - A) (Wahba 1985)
};
inline auto choices(Criterion) {
  return std::array{std::pair{"gcv", Criterion::gcv}, std::pair{"reml", Criterion::reml}};
}

/// Returns the value of the criterion for a fit to n keyframes, over all axes; lower is better.
double score(Criterion criterion, const Reinsch::Fit& fit, std::size_t n);

/// Returns the best lambda [s^3] on the lattice (mean interval)^3 * 10^(k / 8), 1e-6 to 1e12. A
/// lattice makes the choice independent of rounding. About 35 fits.
double select_lambda(const Reinsch& reinsch,
                     const std::vector<double>& stamps,
                     const std::vector<Vector3>& y,
                     Criterion criterion);

}  // namespace loopbench::methods
