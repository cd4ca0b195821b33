/// Error of a loop that ends where it began, without a reference: `eval --end-error`.
#pragma once

#include <string>
#include <vector>

#include "harness/commands/files/named_trajectory.hpp"

namespace loopbench::harness {

/// Distance and angle from the first to the last pose of each file, which are the error if the body
/// returned to its first pose, and the distance in per cent of the path; a line for each, or JSON.
/// Throws InputError.
std::string end_errors(const std::vector<std::string>& files,
                       const ReadArguments& reading,
                       bool json);

}  // namespace loopbench::harness
