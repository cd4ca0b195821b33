#include "methods/smoothers/manifold/family.hpp"

#include <algorithm>
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

}  // namespace loopbench::methods::manifold
