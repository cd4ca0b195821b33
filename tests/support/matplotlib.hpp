/// Whether figures can be drawn on this machine.
#pragma once

#include <cstdlib>

namespace loopbench {

inline bool has_matplotlib() {
  static const bool found = std::system(
                                "python3 -c 'import matplotlib' 2>/dev/null || "
                                "/usr/bin/python3 -c 'import matplotlib' 2>/dev/null") == 0;
  return found;
}

}  // namespace loopbench
