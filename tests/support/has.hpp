/// Whether a text contains another one.
#pragma once

#include <string>

namespace loopbench {

inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace loopbench
