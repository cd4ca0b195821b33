/// Graduated non-convexity: which closures to believe, found while solving.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace loopbench {

enum class Gnc { off, tls, gm };
inline auto choices(Gnc) {
  return std::array{
      std::pair{"off", Gnc::off}, std::pair{"tls", Gnc::tls}, std::pair{"gm", Gnc::gm}};
}

/// A closure's weight at convexity mu, c2 the largest squared error of a true one (Yang et al.,
/// RA-L 2020, equations 14 and 12).
double gnc_weight(Gnc kind, double squared, double c2, double mu);

struct GncResult {
  std::vector<double> weights;
  int rounds = 0;
};

/// Starts from squared errors `squared` at the solution that believes everything, or, when `mu` is
/// given, at one that can be trusted more: then from that convexity on. `solve` takes
/// weights and gives the squared errors at their solution. Truncated least squares sharpens until
/// every weight is 0 or 1, Geman-McClure until mu is 1; 100 rounds at most.
GncResult graduate(Gnc kind,
                   double c2,
                   std::vector<double> squared,
                   std::optional<double> mu,
                   const std::function<std::vector<double>(const std::vector<double>&)>& solve);

}  // namespace loopbench
