/// Parses method names such as "uniform + dm_n4": one method, or a corrector and a smoother.
#pragma once

#include <string>
#include <vector>

#include "methods/method.hpp"

namespace loopbench::harness {

/// The names between the plus signs, trimmed.
std::vector<std::string> split_stages(const std::string& text);

/// Reason why these stages cannot be combined; empty for corrector, smoother, corrector + smoother,
/// method.
std::string why_not_composable(const std::vector<const methods::MethodEntry*>& stages);

}  // namespace loopbench::harness
