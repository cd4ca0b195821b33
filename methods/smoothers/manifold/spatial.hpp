/// Step 8 in space: z' = q(x', y') on windows of M nodes.
#pragma once

#include <optional>
#include <span>

#include "methods/smoothers/manifold/families/frame.hpp"
#include "methods/smoothers/manifold/families/jet.hpp"
#include "methods/smoothers/manifold/spline.hpp"
#include "methods/smoothers/manifold/windows.hpp"

namespace loopbench::methods::manifold {

constexpr double kQuadricCut = 1e-3;  ///< relative to the largest singular value

/// z = q(x, y) with the article's seven monomials x^2, y^2, z, xy, y, x, 1.
struct Quadric {
  using Coefficients = Eigen::Matrix<double, 6, 1>;

  Vector2 centre = Vector2::Zero();                  ///< middle of the fitted points [m]
  double scale = 1.0;                                ///< half their larger range [m]
  double level = 0.0;                                ///< their mean z [m]
  Coefficients coefficients = Coefficients::Zero();  ///< of x^2, y^2, xy, x, y, 1 [m]
  int rank = 0;  ///< number of directions kept; below 6 the points lie on or near a conic

  double operator()(const Vector2& point) const {
    return level + monomials((point - centre) / scale).dot(coefficients);
  }
  Jet<double> operator()(const Jet<double>& x, const Jet<double>& y) const {
    const Jet<double> u = (x - centre.x()) / scale;
    const Jet<double> v = (y - centre.y()) / scale;
    const Coefficients& c = coefficients;
    return level + c[5] + u * (c[0] * u + c[2] * v + c[3]) + v * (c[1] * v + c[4]);
  }
  static Coefficients monomials(const Vector2& u);
};

/// Least-squares fit in z by truncated SVD. Six nodes of a short path lie near a conic, where the
/// full solution amplifies noise; directions with a singular value below `cut` relative to the
/// largest are dropped. Interpolates six points if none is dropped. x and y have a common scale,
/// because separate scales would amplify the noise across a straight path to its length. Returns
/// nullopt for points without extent or fewer than six points; at most twelve are allowed.
std::optional<Quadric> fit_quadric(std::span<const Vector2> points,
                                   std::span<const double> z,
                                   double cut = kQuadricCut);

/// Height as a function of position; empty: the spline's height is kept.
struct Height {
  struct Surface {
    Frame frame;
    Quadric quadric;

    double height(const Vector3& point) const { return quadric(frame.local(point)); }
    Jet<double> height(const MotionJet& point) const {
      const MotionJet from_origin = point - frame.origin;
      return quadric(along(frame.x, from_origin), along(frame.y, from_origin));
    }
  };
  std::optional<Surface> surface;

  template <class T>
  T over(const VectorOf<T>& point, const T& own_height) const {
    return surface ? surface->height(point) : own_height;
  }
};

struct SpatialRule {
  std::size_t size = 7;  ///< M
  Axes axes = Axes::chord;
  bool guarded = true;
  Scheme scheme = Scheme::consecutive;
  double cut = kQuadricCut;     ///< relative singular value below which directions are dropped
  std::size_t plain_below = 0;  ///< segments with fewer nodes keep the spline's height
};

struct SpatialFit {
  std::vector<Window> windows;
  std::vector<Height> pieces;  ///< one per window
  std::size_t truncated = 0;   ///< windows whose nodes lie near a conic
  std::size_t fallbacks = 0;   ///< windows that keep the spline's height
};

/// Fits heights along `up`, relative to the first node. `guarded`: rejects a surface that leaves
/// the spline, on its own edges or one edge next to them, by more than the height range of its
/// nodes; nodes near a conic produce such surfaces even with truncation. O(nodes).
SpatialFit fit_spatial(const Nodes& nodes,
                       std::span<const NodeRange> segments,
                       const NodeSpline& spline,
                       const Vector3& up,
                       const SpatialRule& rule);

}  // namespace loopbench::methods::manifold
