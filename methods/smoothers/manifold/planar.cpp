#include "methods/smoothers/manifold/planar.hpp"

#include <algorithm>
#include <limits>
#include <sstream>

#include "datasets/core/fields.hpp"

namespace loopbench::methods::manifold {
namespace {

int degree(Family family, std::size_t nodes) {
  if (family == Family::line) return 1;
  if (family == Family::by_n) return nodes > 3 ? 3 : 2;
  return family == Family::poly2 ? 2 : 3;
}

// Unpivoted QR divides by zero for equal x: such a fit is invalid.
bool is_valid(const Polynomial& curve) {
  return curve.scale > 0.0 && curve.coefficients.allFinite();
}

template <class Function>
std::optional<PlanarPiece> graph(const Frame& frame, const std::optional<Function>& curve) {
  if (!curve) return std::nullopt;
  return GraphPiece<Function>{frame, *curve};
}

// Near a pole or a turning point a curve leaves the spline between nodes by multiples of the chord;
// valid curves of a window that passes the guard stay below a quarter.
constexpr double kMaxDeviation = 0.25;  // fraction of the chord

constexpr std::size_t kSmallest = 3;  // [nodes] smaller windows are not split; two nodes are a line
constexpr std::array kPolynomial{Family::by_n};

PlanarPiece fallback_piece(const Nodes& nodes,
                           NodeRange range,
                           const NodeSpline& spline,
                           Fallback fallback) {
  if (fallback == Fallback::spline || range.nodes() != 3) return SplinePiece{};
  const std::size_t i = range.first;
  const std::array points{nodes.points[i], nodes.points[i + 1], nodes.points[i + 2]};
  const std::array arc_lengths{spline.distance(i), spline.distance(i + 1), spline.distance(i + 2)};
  const auto arc = fit_arc(points, arc_lengths);
  return arc ? PlanarPiece(ArcPiece{*arc}) : PlanarPiece(SplinePiece{});
}

void keep_chords(const Nodes& nodes, NodeRange segment, PlanarFit& out) {
  for (std::size_t i = segment.first; i < segment.last; ++i) {
    ++out.chords;
    out.keep(
        {{i, i + 1}, {i, i + 1}},
        ChordPiece{nodes.stamps[i], nodes.stamps[i + 1], nodes.points[i], nodes.points[i + 1]});
  }
}

}  // namespace

std::vector<Family> read_families(const std::string& names) {
  std::string words = names;
  std::replace(words.begin(), words.end(), ',', ' ');
  std::istringstream in(words);
  std::vector<Family> out;
  for (std::string word; in >> word;) {
    const auto family = from_text<Family>(word);
    if (!family) {
      throw OptionError("families",
                        "families = " + names + ": unknown family " + word + ", expected " +
                            choice_list<Family>());
    }
    out.push_back(*family);
  }
  if (out.empty())
    throw OptionError("families", "families: expected at least one of " + choice_list<Family>());
  return out;
}

bool is_polynomial(Family family) {
  return family == Family::by_n || family == Family::line || family == Family::poly2 ||
         family == Family::poly3;
}

std::size_t unknowns(Family family, std::size_t nodes) {
  if (is_polynomial(family)) return static_cast<std::size_t>(degree(family, nodes)) + 1;
  return family == Family::implicit ? kImplicitPowers.size() - 1 : 3;
}

std::optional<PlanarPiece> fit_family(Family family,
                                      const Frame& frame,
                                      std::span<const Vector2> points) {
  switch (family) {
    case Family::sin1:
      return graph(frame, fit_sine(points));
    case Family::rat02:
      return graph(frame, fit_rational(points));
    case Family::hyperbola:
      return graph(frame, fit_hyperbola(points));
    case Family::implicit: {
      const auto curve = fit_implicit(points);
      return curve ? std::optional<PlanarPiece>(ImplicitPiece{frame, *curve}) : std::nullopt;
    }
    default: {
      const Polynomial curve = fit_polynomial(points, degree(family, points.size()));
      return is_valid(curve) ? graph(frame, std::optional(curve)) : std::nullopt;
    }
  }
}

bool WindowFitter::admits(const Window& window) const {
  const auto frame = fitting_frame(rule.axes, nodes, window.fitted, up);
  if (!frame) return false;
  if (!rule.guarded) return true;
  std::vector<Vector2> points;
  for (const std::size_t i : picked(window)) points.push_back(frame->local(nodes.points[i]));
  // World x may run against the motion: a graph in reversed x is valid, too.
  if (points.back().x() < points.front().x()) {
    for (Vector2& point : points) point.x() = -point.x();
  }
  return is_graph(points);
}

std::optional<PlanarPiece> WindowFitter::fit(const Window& window,
                                             std::span<const Family> families) const {
  const auto frame = fitting_frame(rule.axes, nodes, window.fitted, up);
  if (!frame) return std::nullopt;
  const std::vector<std::size_t> node_indices = picked(window);
  std::optional<PlanarPiece> best;
  double lowest = std::numeric_limits<double>::infinity();
  for (const Family family : families) {
    auto piece = fit(family, *frame, node_indices);
    if (!piece) continue;
    if (rule.guarded && !is_polynomial(family) && !stays_near_spline(*piece, window)) continue;
    if (rule.selection == Selection::fixed && !rule.piece_cost) return piece;
    const double cost = rule.piece_cost ? rule.piece_cost(*piece, window, nodes, spline)
                                        : leave_one_out(family, *frame, node_indices);
    if (best && !(cost < lowest)) continue;
    best = piece;
    lowest = cost;
  }
  return best;
}

std::optional<PlanarPiece> WindowFitter::fit(Family family,
                                             const Frame& frame,
                                             std::span<const std::size_t> node_indices) const {
  std::vector<Vector2> points;
  points.reserve(node_indices.size());
  for (const std::size_t i : node_indices) points.push_back(frame.local(nodes.points[i]));
  return fit_family(family, frame, points);
}

double WindowFitter::leave_one_out(Family family,
                                   const Frame& frame,
                                   std::span<const std::size_t> node_indices) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < node_indices.size(); ++k) {
    std::vector<std::size_t> rest(node_indices.begin(), node_indices.end());
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(k));
    // With fewer nodes fit_polynomial() would reduce the degree, which is another family.
    if (unknowns(family, node_indices.size()) > rest.size()) {
      return std::numeric_limits<double>::infinity();
    }
    const auto refitted = fit(family, frame, rest);
    if (!refitted) return std::numeric_limits<double>::infinity();
    sum += squared_error(*refitted, node_indices[k]);
  }
  return sum;
}

double WindowFitter::squared_error(const PlanarPiece& piece, std::size_t node) const {
  const SplinePoint position{nodes.points[node], spline.distance(node), nodes.stamps[node]};
  return (value_of_piece(piece, position) - nodes.points[node]).squaredNorm();
}

bool WindowFitter::stays_near_spline(const PlanarPiece& piece, const Window& window) const {
  const Vector3 chord = nodes.points[window.fitted.last] - nodes.points[window.fitted.first];
  const double max_deviation = kMaxDeviation * chord.norm();
  return holds_along(nodes, spline, window, [&](const SplinePoint& position) {
    return (value_of_piece(piece, position) - position.point).norm() <= max_deviation;
  });
}

PlanarFit fit_planar(const Nodes& nodes,
                     std::span<const NodeRange> segments,
                     const NodeSpline& spline,
                     const Vector3& up,
                     const PlanarRule& rule) {
  PlanarFit out;
  // Reserves memory, because reallocation would move every piece.
  const std::size_t steps = rule.scheme == Scheme::sliding_blend ? 1 : rule.size - 1;
  out.windows.reserve(nodes.size() / steps + segments.size());
  out.pieces.reserve(nodes.size() / steps + segments.size());
  const WindowFitter fitter{nodes, spline, up, rule};
  // Fits the families of the rule, or a polynomial if they fail; returns nullopt if the guard
  // rejects the window.
  const auto fit = [&](const Window& window) -> std::optional<PlanarPiece> {
    if (!fitter.admits(window)) return std::nullopt;
    if (auto piece = fitter.fit(window, rule.families)) return piece;
    auto piece = fitter.fit(window, kPolynomial);
    if (piece) ++out.refused;
    return piece;
  };
  const auto fit_small = [&](const Window& window) {
    if (const auto piece = fit(window)) return out.keep(window, *piece);
    ++out.fallbacks;
    out.keep(window, fallback_piece(nodes, window.fitted, spline, rule.fallback));
  };
  for (const NodeRange& segment : segments) {
    if (segment.nodes() < rule.chords_below) {
      keep_chords(nodes, segment, out);
      continue;
    }
    for (const Window& window : windows(segment, rule.size, nodes.size(), rule.scheme)) {
      if (window.fitted.nodes() <= kSmallest || !rule.guarded) {
        fit_small(window);
      } else if (const auto piece = fit(window)) {
        out.keep(window, *piece);
      } else {
        ++out.split;
        for (const Window& part : windows(window.owned, kSmallest, nodes.size())) fit_small(part);
      }
    }
  }
  return out;
}

}  // namespace loopbench::methods::manifold
