#include "methods/smoothers/manifold/spatial.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <numeric>

#include "methods/smoothers/manifold/families/fitting.hpp"

namespace loopbench::methods::manifold {
namespace {

constexpr double kRounding = 1e-9;  // fraction of the window size, for level motion

bool stays_near_spline(const Height::Surface& surface,
                       const Nodes& nodes,
                       const Window& window,
                       const NodeSpline& spline,
                       const Vector3& up) {
  double low = up.dot(nodes.points[window.fitted.first]);
  double high = low;
  for (std::size_t i = window.fitted.first; i <= window.fitted.last; ++i) {
    low = std::min(low, up.dot(nodes.points[i]));
    high = std::max(high, up.dot(nodes.points[i]));
  }
  const double max_deviation = high - low + kRounding * surface.quadric.scale;
  return holds_along(nodes, spline, window, [&](const SplinePoint& position) {
    const double deviation = surface.height(position.point) - up.dot(position.point);
    return !(std::abs(deviation) > max_deviation);
  });
}

std::optional<Height::Surface> fit_surface(const Nodes& nodes,
                                           const Window& window,
                                           const Vector3& up,
                                           const SpatialRule& rule) {
  const auto frame = fitting_frame(rule.axes, nodes, window.fitted, up);
  if (!frame) return std::nullopt;
  std::vector<double> heights;
  std::vector<Vector2> points;
  for (const std::size_t i : picked(window)) {
    heights.push_back(up.dot(nodes.points[i]));
    points.push_back(frame->local(nodes.points[i]));
  }
  const auto quadric = fit_quadric(points, heights, rule.cut);
  if (!quadric) return std::nullopt;
  return Height::Surface{*frame, *quadric};
}

}  // namespace

Quadric::Coefficients Quadric::monomials(const Vector2& u) {
  Coefficients out;
  out << u.x() * u.x(), u.y() * u.y(), u.x() * u.y(), u.x(), u.y(), 1.0;
  return out;
}

std::optional<Quadric> fit_quadric(std::span<const Vector2> points,
                                   std::span<const double> z,
                                   double cut) {
  const auto count = static_cast<Eigen::Index>(points.size());
  if (count < 6) return std::nullopt;
  const Extent extent(points);
  Quadric out;
  out.centre = extent.centre();
  out.scale = 0.5 * extent.size().maxCoeff();
  out.level = std::accumulate(z.begin(), z.end(), 0.0) / static_cast<double>(count);
  if (!(out.scale > 0.0)) return std::nullopt;

  Eigen::Matrix<double, Eigen::Dynamic, 6, 0, kMaxNodes, 6> design(count, 6);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxNodes, 1> height(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    design.row(i) = Quadric::monomials((points[k] - out.centre) / out.scale).transpose();
    height[i] = z[k] - out.level;
  }
  Eigen::JacobiSVD<decltype(design)> svd(design, Eigen::ComputeFullU | Eigen::ComputeFullV);
  svd.setThreshold(cut);
  out.coefficients = svd.solve(height);
  out.rank = static_cast<int>(svd.rank());
  return out;
}

SpatialFit fit_spatial(const Nodes& nodes,
                       std::span<const NodeRange> segments,
                       const NodeSpline& spline,
                       const Vector3& up,
                       const SpatialRule& rule) {
  SpatialFit out;
  const std::size_t steps = rule.scheme == Scheme::sliding_blend ? 1 : rule.size - 1;
  out.windows.reserve(nodes.size() / steps + segments.size());
  out.pieces.reserve(nodes.size() / steps + segments.size());
  for (const NodeRange& segment : segments) {
    if (segment.nodes() < rule.plain_below) {
      ++out.fallbacks;
      out.windows.push_back({segment, segment});
      out.pieces.emplace_back();
      continue;
    }
    for (const Window& window : windows(segment, rule.size, nodes.size(), rule.scheme)) {
      auto surface = fit_surface(nodes, window, up, rule);
      if (surface && rule.guarded && !stays_near_spline(*surface, nodes, window, spline, up))
        surface.reset();
      if (!surface) ++out.fallbacks;
      if (surface && surface->quadric.rank < 6) ++out.truncated;
      out.windows.push_back(window);
      out.pieces.push_back({surface});
    }
  }
  return out;
}

}  // namespace loopbench::methods::manifold
