#include "harness/commands/checks.hpp"

#include <cmath>
#include <cstdlib>

namespace loopbench::harness {

CLI::Validator finite_number() {
  const auto check = [](std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool is_number = end != text.c_str() && *end == '\0';
    return is_number && std::isfinite(value) ? std::string() : text + " is not a finite number";
  };
  return CLI::Validator(check, "");
}

CLI::Validator positive_number() {
  // CLI11's own validator prints the limits of a double with all digits.
  const auto check = [](std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool is_number = end != text.c_str() && *end == '\0';
    return is_number && value > 0.0 ? std::string() : text + " is not a number > 0";
  };
  return CLI::Validator(check, "");
}

}  // namespace loopbench::harness
