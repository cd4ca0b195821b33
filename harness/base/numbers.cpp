#include "harness/base/numbers.hpp"

#include <charconv>
#include <cmath>

namespace loopbench::harness {

std::vector<double> comma_separated_numbers(const std::string& text) {
  std::vector<double> out;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    double value = 0.0;
    const auto [rest, error] = std::from_chars(at, end, value);
    if (error != std::errc{} || !std::isfinite(value)) return {};
    if (rest != end && *rest != ',') return {};
    out.push_back(value);
    if (rest == end) return out;
    for (at = rest + 1; at != end && *at == ' ';) ++at;
  }
}

}  // namespace loopbench::harness
