#include "metrics/doctor/information_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace loopbench::metrics {
namespace {

SquaredError median_of_loops(const std::vector<Edge>& closures,
                             const Chain& chain,
                             bool exchanged) {
  std::vector<SquaredError> all;
  for (const Edge& closure : closures) {
    all.push_back(closure_error(closure, chain, exchanged, false));
  }
  return median_error(all);
}

/// How far translation and rotation are from what is stated, in logarithms.
double distance(const SquaredError& error) {
  const auto logarithm = [](double x) { return std::abs(std::log(std::max(x, 1e-12))); };
  return logarithm(error.translation) + logarithm(error.rotation);
}

std::string text(const SquaredError& error) {
  return fmt::format(
      "{:.3g} (translation) and {:.3g} (rotation)", error.translation, error.rotation);
}

}  // namespace

std::vector<InputFinding> check_information(const std::vector<Edge>& closures,
                                            const Chain& chain,
                                            const Chain& exchanged) {
  constexpr std::size_t kFewest = 2;
  constexpr double kFar = 1000.0, kNear = 100.0, kTooLarge = 100.0,
                   kTooSmall = 1e-5;  // in variance
  if (closures.size() < kFewest) return {};
  const SquaredError stated = median_of_loops(closures, chain, false);
  const SquaredError other = median_of_loops(closures, exchanged, true);
  const double before = distance(stated);
  const double after = distance(other);
  if (before > std::log(kFar) && after < std::min(0.5 * before, std::log(kNear))) {
    return {{Fault::information_order,
             fmt::format("squared gaps of the loops are {} times the stated variances; {} after "
                         "exchange of the blocks",
                         text(stated),
                         text(other)),
             "write the information in the order of the format: g2o has x y z first",
             1.0 - after / before,
             before}};
  }
  const auto [smaller, larger] = std::minmax(stated.translation, stated.rotation);
  const bool is_too_large = smaller > kTooLarge;
  if (!is_too_large && larger > kTooSmall) return {};
  return {{Fault::information_scale,
           fmt::format("squared gaps of the loops are {} times the stated variances (median of {})",
                       text(stated),
                       closures.size()),
           is_too_large ? "the stated information is too large: divide it"
                        : "the stated information is too small: multiply it",
           0.8,
           stated.translation}};
}

}  // namespace loopbench::metrics
