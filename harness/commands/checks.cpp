#include "harness/commands/checks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace loopbench::harness {

namespace {

/// CLI11's own validators let NaN pass, and print the limits of a double with all digits.
template <class Accepts>
CLI::Validator number(const std::string& expected, Accepts accepts) {
  const auto check = [=](std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool is_number = end != text.c_str() && *end == '\0';
    return is_number && accepts(value) ? std::string() : text + " is not a " + expected;
  };
  return CLI::Validator(check, "");
}

}  // namespace

CLI::Validator finite_number() {
  return number("finite number", [](double value) { return std::isfinite(value); });
}

CLI::Validator number_between(double low, double high) {
  return number(fmt::format("number from {} to {}", low, high),
                [=](double value) { return low <= value && value <= high; });
}

CLI::Validator positive_number() {
  return number("number > 0", [](double value) { return value > 0.0; });
}

}  // namespace loopbench::harness
