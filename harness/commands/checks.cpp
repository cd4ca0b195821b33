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

}  // namespace loopbench::harness
