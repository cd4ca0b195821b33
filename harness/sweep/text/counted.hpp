/// Numbers of things in messages.
#pragma once

#include <cstddef>
#include <string>

namespace loopbench::harness {

/// "1 pose", "2 poses".
inline std::string counted(std::size_t count, const std::string& one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

}  // namespace loopbench::harness
