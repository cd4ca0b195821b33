/// The fitted numbers in the article's notation and order: alpha(i,j), beta(i,j,k).
#pragma once

#include <string>
#include <vector>

#include "methods/smoothers/manifold/pieces.hpp"
#include "methods/smoothers/manifold/spatial.hpp"

namespace loopbench::manifold {

/// One coefficient, in metres of the window's own frame (centring and scaling undone).
struct Coefficient {
  std::string name;
  double value;
};

/// y = +f(x): falling powers of x, then alpha(0,1) = 1 and alpha(0,0), as the article prints
/// parabolas and cubics. Its F = ... + y = 0 would mean y = -f(x); its numbers fit the truth with
/// the other sign (design section 3), so ours are printed that way.
std::vector<Coefficient> coefficients(const Polynomial& curve, int degree);

std::vector<Coefficient> coefficients(const Sine& curve);       ///< a, b, c [, d]
std::vector<Coefficient> coefficients(const Rational& curve);   ///< p, q1, q2 [, d]
std::vector<Coefficient> coefficients(const Hyperbola& curve);  ///< c0, c1, q
std::vector<Coefficient> coefficients(const Implicit& curve);   ///< falling degree, |scaled| = 1

/// beta(2,0,0), (0,2,0), (0,0,1) = 1, (1,1,0), (0,1,0), (1,0,0), (0,0,0) with z = +q(x, y), heights
/// from `base_height` [m].
std::vector<Coefficient> coefficients(const Quadric& surface, double base_height);

/// Of a piece, with the family's name; only the name for pieces that are no curve of a family.
std::string description(const PlanarPiece& piece);

/// The name alone: "parabola", "sin1", "arc".
std::string family_name(const PlanarPiece& piece);

/// "alpha(2,0) = 1.238, ...".
std::string text(const std::vector<Coefficient>& coefficients);

}  // namespace loopbench::manifold
