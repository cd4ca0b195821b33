/// Curves that the article prints with their coefficients, in the reference's axes [m].
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "harness/article/paper_run.hpp"

namespace loopbench::harness {

struct PrintedCurve {
  const char* where;
  const char* sequence;
  std::string text;  ///< the equation with its coefficients
  std::function<double(double)> f;
  std::size_t nodes;          ///< N quoted as best, or 5
  double wavelength = 0.0;    ///< of the sine [m]
  std::vector<double> poles;  ///< [m]
};

const std::vector<PrintedCurve>& printed_curves();

struct PrintedQuadric {
  const char* where;
  const char* sequence;
  std::string text;
  std::array<double, 6> beta;  ///< of x^2, y^2, x y, y, x, 1
  std::size_t nodes;           ///< M quoted as best, or 6

  double height(double x, double y) const {
    return beta[0] * x * x + beta[1] * y * y + beta[2] * x * y + beta[3] * y + beta[4] * x +
           beta[5];
  }
};

const std::vector<PrintedQuadric>& printed_quadrics();

/// Where a printed curve is nearest to the reference.
struct Meeting {
  double rms = 0.0;               ///< of y - sign f(x) [m]
  double begin = 0.0, end = 0.0;  ///< [s]
};

/// The `nodes` consecutive keyframes between which the reference is nearest to y = sign f(x); the
/// best of a search over the run, so it suggests but does not prove that the curve was fitted
/// there.
Meeting best_meeting(const PaperCell& raw, const PrintedCurve& curve, double sign);

}  // namespace loopbench::harness
