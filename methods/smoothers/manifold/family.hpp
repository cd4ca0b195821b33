/// The names of the curve families, and one of them fitted to given nodes.
#pragma once

#include <string>
#include <vector>

#include "methods/smoothers/manifold/pieces.hpp"

namespace loopbench::manifold {

/// by_n: parabola on 3 nodes, cubic on more. The rest as the article lists them.
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

/// "poly2 sin1" or "poly2, sin1" as families. Throws OptionError for an unknown or no name.
std::vector<Family> read_families(const std::string& names);

struct FamilyRule {
  int implicit_order = 2;  ///< n of F(x, y)
  bool level = false;      ///< sin1 and rat02 get a constant; the article has none
};

/// Parameters of the family on so many nodes: what the choice between families pays for.
std::size_t unknowns(Family family, std::size_t nodes, const FamilyRule& rule);

bool is_polynomial(Family family);

/// Fitted to points of the frame. Nothing when they are too few or the family refuses them: a
/// pole, an alias, no extent.
std::optional<PlanarPiece> fit_family(Family family,
                                      const Frame& frame,
                                      std::span<const Vector2> points,
                                      const FamilyRule& rule);

/// The polynomial families as r(s): nothing when two nodes coincide.
std::optional<PlanarPiece> fit_along(Family family,
                                     std::span<const Vector3> points,
                                     std::span<const double> ways);

}  // namespace loopbench::manifold
