/// Detection of methods and metrics that change what they must not: their input and the
/// floating-point mode.
#pragma once

#include <cfenv>
#include <string_view>
#include <vector>

#include "harness/base/hash.hpp"
#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::harness {

/// The bytes in memory of what a method or a metric reads, valid as long as that is.
using Inputs = std::vector<std::string_view>;
Inputs inputs_of(const Problem& problem);
Inputs inputs_of(const metrics::Evaluation& evaluation);

class InputGuard {
 public:
  /// Before the code runs. O(bytes), at some gigabytes per second.
  explicit InputGuard(Inputs inputs);
  ~InputGuard();  ///< restores the floating-point mode
  InputGuard(const InputGuard&) = delete;
  InputGuard& operator=(const InputGuard&) = delete;

  /// After it has returned, on the same thread: "changed its input" or what else it changed; empty
  /// if nothing.
  std::string fault() const;

 private:
  Inputs inputs_;
  Hash content_;
  std::fenv_t mode_;
};

}  // namespace loopbench::harness
