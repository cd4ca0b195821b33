/// Curve families and their fit to given nodes.
#pragma once

#include <string>
#include <vector>

#include "methods/smoothers/manifold/pieces.hpp"

namespace loopbench::methods::manifold {

/// by_n: parabola for 3 nodes, cubic for more. The others are named in the article.
enum class Family { by_n, line, poly2, poly3, sin1, rat02, hyperbola, implicit };
inline auto choices(Family) {
  return std::array{std::pair{"by_n", Family::by_n},
                    std::pair{"line", Family::line},
                    std::pair{"poly2", Family::poly2},
                    std::pair{"poly3", Family::poly3},
                    std::pair{"sin1", Family::sin1},
                    std::pair{"rat02", Family::rat02},
                    std::pair{"hyperbola", Family::hyperbola},
                    std::pair{"implicit", Family::implicit}};
}

/// Parses a list such as "poly2 sin1" or "poly2, sin1". Throws OptionError for an unknown family or
/// an empty list.
std::vector<Family> read_families(const std::string& names);

/// Returns the number of parameters of the family for this number of nodes, as used by `selection`.
std::size_t unknowns(Family family, std::size_t nodes);

bool is_polynomial(Family family);

/// Fits the family to points in the frame. Returns nullopt for too few points or an invalid fit (a
/// pole, an alias, no extent).
std::optional<PlanarPiece> fit_family(Family family,
                                      const Frame& frame,
                                      std::span<const Vector2> points);

}  // namespace loopbench::methods::manifold
