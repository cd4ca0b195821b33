/// Names of signals.
#pragma once

#include <cstring>
#include <string>

namespace loopbench::harness {

/// For example "SIGSEGV".
inline std::string signal_name(int signal) {
  const char* name = sigabbrev_np(signal);
  return name == nullptr ? "signal " + std::to_string(signal) : "SIG" + std::string(name);
}

}  // namespace loopbench::harness
