/// Lists of numbers in arguments.
#pragma once

#include <string>
#include <vector>

namespace loopbench::harness {

/// Comma-separated finite numbers; empty if `text` is anything else.
std::vector<double> comma_separated_numbers(const std::string& text);

}  // namespace loopbench::harness
