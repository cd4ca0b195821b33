/// Graduated non-convexity: estimates inlier weights of the closures while solving.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace loopbench::methods {

enum class Gnc { off, tls, gm };
inline auto choices(Gnc) {
  return std::array{
      std::pair{"off", Gnc::off}, std::pair{"tls", Gnc::tls}, std::pair{"gm", Gnc::gm}};
}

/// Weight of a closure with squared error `squared` at convexity mu. c2 is the largest squared
/// error of an inlier (Yang et al., RA-L 2020, equations 14 and 12).
double gnc_weight(Gnc kind, double squared, double c2, double mu);

struct GncResult {
  std::vector<double> weights;
  int rounds = 0;
};

/// Alternates between weights and solutions. `squared` holds the squared errors of the closures at
/// the initial solution. Without `mu`, that solution uses all closures with weight 1 and the
/// initial convexity is computed from the largest error; with `mu`, the solution is more reliable
/// and the schedule starts at that convexity. `solve` takes weights and returns the squared errors
/// at their solution. Truncated least squares ends when every weight is 0 or 1, Geman-McClure when
/// mu is 1, both after at most 100 rounds.
GncResult graduate_weights(
    Gnc kind,
    double c2,
    std::vector<double> squared,
    std::optional<double> mu,
    const std::function<std::vector<double>(const std::vector<double>&)>& solve);

}  // namespace loopbench::methods
