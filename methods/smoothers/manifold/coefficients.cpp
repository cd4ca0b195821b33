#include "methods/smoothers/manifold/coefficients.hpp"

#include <cstdio>

namespace loopbench::methods::manifold {
namespace {

std::string alpha(int i, int j) {
  return "alpha(" + std::to_string(i) + "," + std::to_string(j) + ")";
}

int degree_of(const Polynomial& curve) {
  const auto& c = curve.coefficients;
  return c[3] != 0.0 ? 3 : c[2] != 0.0 ? 2 : 1;
}

std::string named(const GraphPiece<Polynomial>& piece) {
  const int degree = degree_of(piece.curve);
  return degree == 3 ? "cubic" : degree == 2 ? "parabola" : "line";
}
std::string named(const GraphPiece<Sine>&) { return "sin1"; }
std::string named(const GraphPiece<Rational>&) { return "rat02"; }
std::string named(const GraphPiece<Hyperbola>&) { return "hyperbola"; }
std::string named(const ImplicitPiece&) { return "implicit"; }
std::string named(const ArcPiece&) { return "arc"; }
std::string named(const ArcPolynomialPiece&) { return "arc polynomial"; }
std::string named(const RegressionPiece&) { return "regression spline"; }
std::string named(const ChordPiece&) { return "chord"; }
std::string named(const SplinePiece&) { return "spline"; }

template <class Function>
std::string described(const GraphPiece<Function>& piece) {
  return named(piece) + ": " + text(coefficients(piece.curve));
}
std::string described(const GraphPiece<Polynomial>& piece) {
  return "polynomial: " + text(coefficients(piece.curve, degree_of(piece.curve)));
}
std::string described(const ImplicitPiece& piece) {
  return named(piece) + ": " + text(coefficients(piece.curve));
}
template <class Shape>
std::string described(const Shape& piece) {
  return named(piece);
}

}  // namespace

std::vector<Coefficient> coefficients(const Polynomial& curve, int degree) {
  // Expands Horner's scheme in u = (x - m) / s into powers of x, from the inside.
  const double slope = 1.0 / curve.scale;
  const double offset = -curve.centre / curve.scale;
  Eigen::Vector4d powers = Eigen::Vector4d::Zero();
  for (int k = degree; k >= 0; --k) {
    Eigen::Vector4d next = offset * powers;
    next.tail<3>() += slope * powers.head<3>();
    next[0] += curve.coefficients[k];
    powers = next;
  }
  std::vector<Coefficient> out;
  for (int k = degree; k > 0; --k) out.push_back({alpha(k, 0), powers[k]});
  out.push_back({alpha(0, 1), 1.0});
  out.push_back({alpha(0, 0), powers[0]});
  return out;
}

std::vector<Coefficient> coefficients(const Sine& curve) {
  std::vector<Coefficient> out{{"a", curve.amplitude}, {"b", curve.rate}, {"c", curve.phase}};
  if (curve.level != 0.0) out.push_back({"d", curve.level});
  return out;
}

std::vector<Coefficient> coefficients(const Rational& curve) {
  const double m = curve.centre;
  const double s = curve.scale;
  std::vector<Coefficient> out{{"p", curve.p * s * s},
                               {"q1", s * curve.q1 - 2.0 * m},
                               {"q2", m * m - s * curve.q1 * m + s * s * curve.q2}};
  if (curve.level != 0.0) out.push_back({"d", curve.level});
  return out;
}

std::vector<Coefficient> coefficients(const Hyperbola& curve) {
  return {{"c0", curve.c0}, {"c1", curve.c1 * curve.scale}, {"q", -curve.pole}};
}

std::vector<Coefficient> coefficients(const Implicit& curve) {
  // Expands each (x - mx)^i (y - my)^j / s^(i+j) into powers of x and y.
  constexpr std::array<std::array<double, 4>, 4> choose{
      {{1, 0, 0, 0}, {1, 1, 0, 0}, {1, 2, 1, 0}, {1, 3, 3, 1}}};
  std::array<std::array<double, 4>, 4> sums{};
  for (Eigen::Index k = 0; k < curve.alpha.size(); ++k) {
    const auto [i, j] = implicit_powers(curve.order, k);
    const double scaled = curve.alpha[k] / std::pow(curve.scale, i + j);
    for (int a = 0; a <= i; ++a) {
      for (int b = 0; b <= j; ++b) {
        const auto ia = static_cast<std::size_t>(a), ib = static_cast<std::size_t>(b);
        sums[ia][ib] += scaled * choose[static_cast<std::size_t>(i)][ia] *
                        choose[static_cast<std::size_t>(j)][ib] *
                        std::pow(-curve.centre.x(), i - a) * std::pow(-curve.centre.y(), j - b);
      }
    }
  }
  std::vector<Coefficient> out;
  for (Eigen::Index k = 0; k < curve.alpha.size(); ++k) {
    const auto [i, j] = implicit_powers(curve.order, k);
    out.push_back({alpha(i, j), sums[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]});
  }
  return out;
}

std::vector<Coefficient> coefficients(const Quadric& surface, double base_height) {
  const double s = surface.scale;
  const Vector2& m = surface.centre;
  const Quadric::Coefficients& c = surface.coefficients;  // of u^2, v^2, uv, u, v, 1
  const double xx = c[0] / (s * s), yy = c[1] / (s * s), xy = c[2] / (s * s);
  const double x = c[3] / s - 2.0 * xx * m.x() - xy * m.y();
  const double y = c[4] / s - 2.0 * yy * m.y() - xy * m.x();
  const double one = base_height + surface.level + c[5] - c[3] / s * m.x() - c[4] / s * m.y() +
                     xx * m.x() * m.x() + yy * m.y() * m.y() + xy * m.x() * m.y();
  return {{"beta(2,0,0)", xx},
          {"beta(0,2,0)", yy},
          {"beta(0,0,1)", 1.0},
          {"beta(1,1,0)", xy},
          {"beta(0,1,0)", y},
          {"beta(1,0,0)", x},
          {"beta(0,0,0)", one}};
}

std::string description(const PlanarPiece& piece) {
  return std::visit([](const auto& shape) { return described(shape); }, piece);
}

std::string family_name(const PlanarPiece& piece) {
  return std::visit([](const auto& shape) { return named(shape); }, piece);
}

std::string text(const std::vector<Coefficient>& coefficients) {
  std::string out;
  for (const auto& [name, value] : coefficients) {
    char number[32];
    std::snprintf(number, sizeof number, "%.6g", value);
    out += (out.empty() ? "" : ", ") + name + " = " + number;
  }
  return out;
}

}  // namespace loopbench::methods::manifold
