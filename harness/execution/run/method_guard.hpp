/// Detection of methods that change what they must not: their input and the floating-point mode.
#pragma once

#include <cfenv>

#include "datasets/core/problem.hpp"
#include "harness/text/hash.hpp"

namespace loopbench::harness {

class MethodGuard {
 public:
  /// Before the method runs. O(size of the problem), at some gigabytes per second. `problem` must
  /// outlive the guard.
  explicit MethodGuard(const Problem& problem);
  ~MethodGuard();  ///< restores the floating-point mode
  MethodGuard(const MethodGuard&) = delete;
  MethodGuard& operator=(const MethodGuard&) = delete;

  /// After it has returned, on the same thread. Throws std::runtime_error with what it changed.
  void require_unchanged() const;

 private:
  const Problem& problem_;
  Hash content_;
  std::fenv_t mode_;
};

}  // namespace loopbench::harness
