/// The most memory a process has held: Linux only, 0 where there is no /proc.
#pragma once

#include <fstream>
#include <string>

namespace loopbench::test {

/// Since the last reset [MiB].
inline double peak_megabytes() {
  std::ifstream in("/proc/self/status");
  for (std::string word; in >> word;) {
    double kilobytes = 0.0;
    if (word == "VmHWM:" && in >> kilobytes) return kilobytes / 1024.0;
  }
  return 0.0;
}

/// Forgets the peak; returns what is held now [MiB].
inline double reset_peak() {
  std::ofstream("/proc/self/clear_refs") << 5;
  return peak_megabytes();
}

}  // namespace loopbench::test
