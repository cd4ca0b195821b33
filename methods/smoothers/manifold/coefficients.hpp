/// Fitted coefficients in the article's notation and order: alpha(i,j), beta(i,j,k).
#pragma once

#include <string>
#include <vector>

#include "methods/smoothers/manifold/pieces.hpp"
#include "methods/smoothers/manifold/spatial.hpp"

namespace loopbench::methods::manifold {

/// One coefficient in metres of the window's frame, after undoing centring and scaling.
struct Coefficient {
  std::string name;
  double value;
};

/// Coefficients of y = +f(x): falling powers of x, then alpha(0,1) = 1 and alpha(0,0), in the order
/// of the article. The article's F = ... + y = 0 would mean y = -f(x), but its printed numbers fit
/// the ground truth with the other sign (design section 3), which is used here.
std::vector<Coefficient> coefficients(const Polynomial& curve, int degree);

std::vector<Coefficient> coefficients(const Sine& curve);       ///< a, b, c [, d]
std::vector<Coefficient> coefficients(const Rational& curve);   ///< p, q1, q2 [, d]
std::vector<Coefficient> coefficients(const Hyperbola& curve);  ///< c0, c1, q
std::vector<Coefficient> coefficients(const Implicit& curve);   ///< falling degree, |scaled| = 1

/// Coefficients of z = +q(x, y): beta(2,0,0), (0,2,0), (0,0,1) = 1, (1,1,0), (0,1,0), (1,0,0),
/// (0,0,0), with heights relative to `base_height` [m].
std::vector<Coefficient> coefficients(const Quadric& surface, double base_height);

/// Family name and coefficients of a piece; only the name for pieces that are not curves of a
/// family.
std::string description(const PlanarPiece& piece);

/// Family name of a piece: "parabola", "sin1", "arc".
std::string family_name(const PlanarPiece& piece);

/// Formats coefficients as "alpha(2,0) = 1.238, ...".
std::string text(const std::vector<Coefficient>& coefficients);

}  // namespace loopbench::methods::manifold
