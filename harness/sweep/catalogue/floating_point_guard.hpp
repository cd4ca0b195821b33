/// The floating-point mode (rounding, traps, denormals) before and after code of others.
#pragma once

#include <cfenv>

namespace loopbench::harness {

/// Restores the mode of the calling thread at the end of its scope.
class FloatingPointGuard {
 public:
  FloatingPointGuard() { std::fegetenv(&mode_); }
  ~FloatingPointGuard() { std::fesetenv(&mode_); }
  FloatingPointGuard(const FloatingPointGuard&) = delete;
  FloatingPointGuard& operator=(const FloatingPointGuard&) = delete;

 private:
  std::fenv_t mode_;
};

}  // namespace loopbench::harness
