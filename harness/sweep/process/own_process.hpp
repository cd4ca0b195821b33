/// Runs code of others without effects on this process.
#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

namespace loopbench::harness {

/// The process ended or exceeded a limit before `work` returned.
class ProcessFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline constexpr double kLongestCheck = 10.0;  ///< [s], of options by the code of a plugin

struct ProcessLimits {
  double seconds = 60.0;    ///< 0: none
  std::int64_t memory = 0;  ///< growth [bytes]; 0: none
};

/// What `work` returns in a copy of this process, which ends then with all that it started. Its
/// standard output goes to the standard error. Rethrows OptionError and InputError, any other
/// exception as std::runtime_error with its message. Throws ProcessFailure ("ended by SIGSEGV").
std::string in_own_process(const std::function<std::string()>& work,
                           const ProcessLimits& limits = {});

}  // namespace loopbench::harness
