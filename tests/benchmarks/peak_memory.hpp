/// Peak resident memory of this process: Linux only, 0 without /proc.
#pragma once

#include <fstream>
#include <string>

namespace loopbench::test {

/// Peak since the last reset [MiB].
inline double peak_megabytes() {
  std::ifstream in("/proc/self/status");
  for (std::string word; in >> word;) {
    double kilobytes = 0.0;
    if (word == "VmHWM:" && in >> kilobytes) return kilobytes / 1024.0;
  }
  return 0.0;
}

/// Resets the peak; returns the current resident size [MiB].
inline double reset_peak() {
  std::ofstream("/proc/self/clear_refs") << 5;
  return peak_megabytes();
}

}  // namespace loopbench::test
