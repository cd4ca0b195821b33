/// The natural cubic spline that trades closeness against bending, for one lambda.
#pragma once

#include <vector>

#include "methods/smoothers/penalised/slope_change.hpp"

namespace loopbench {

/// Minimises sum |y_i - f(t_i)|^2 + lambda int |f''|^2. With Q = D' (slope_change.hpp) and R the
/// tridiagonal Gram matrix of the hat functions,
///
///     (R + lambda Q'Q) gamma = Q'y,   f(t_i) = y_i - lambda (Q gamma)_i,   f''(t_i) = gamma_i.
///
/// lambda -> 0 interpolates, lambda -> infinity is the straight line of regression. O(n).
/// Source: Reinsch 1967; Green & Silverman 1994, ch. 2; Hutchinson & de Hoog 1985 for the trace.
class Reinsch {
 public:
  struct Fit {
    std::vector<Vector3> values;   ///< f at the stamps
    std::vector<Vector3> bends;    ///< f'' at the stamps, zero at both ends
    double free = 0.0;             ///< tr(I - A), the degrees of freedom left an axis
    Vector3 residual;              ///< y' (I - A)^2 y, an axis each
    Vector3 energy;                ///< y' (I - A) y, an axis each
    double log_determinant = 0.0;  ///< of I - A on its range, but for a constant of the stamps
  };

  /// Three strictly increasing stamps or more.
  explicit Reinsch(const std::vector<double>& stamps);

  /// A is the matrix with values = A y. lambda > 0 [s^3].
  Fit fit(const std::vector<Vector3>& y, double lambda) const;

 private:
  SlopeChange slope_change_;
  Pentadiagonal gram_;   ///< R
  Pentadiagonal outer_;  ///< Q'Q
};

/// How lambda is chosen from the data alone.
enum class Criterion {
  gcv,   ///< n |(I - A) y|^2 / tr(I - A)^2 (Craven & Wahba 1979)
  reml,  ///< restricted likelihood: (n - 2) log y'(I - A)y - log det+ (I - A) (Wahba 1985)
};
inline auto choices(Criterion) {
  return std::array{std::pair{"gcv", Criterion::gcv}, std::pair{"reml", Criterion::reml}};
}

/// What the criterion makes of a fit to n keyframes, all axes together; less is better.
double score(Criterion criterion, const Reinsch::Fit& fit, std::size_t n);

/// The best lambda [s^3] among the mean interval cubed times 10^(k / 8), 1e-6 to 1e12: a lattice,
/// so that the choice does not hang on rounding. About 35 fits.
double chosen_lambda(const Reinsch& reinsch,
                     const std::vector<double>& stamps,
                     const std::vector<Vector3>& y,
                     Criterion criterion);

}  // namespace loopbench
