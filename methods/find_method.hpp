/// Built-in methods by name, for programs that embed the library.
#pragma once

#include <string>

#include "methods/method.hpp"

namespace loopbench::methods {

/// Throws InputError with all names if no method has this one.
MethodEntry find_method(const std::string& name);

/// Returns the keyframes as moved by the built-in corrector `name`. Throws OptionError, InputError
/// if there is no such corrector or it is not applicable to this problem, and std::runtime_error if
/// it fails.
Trajectory correct(const Problem& problem, const std::string& name, const Params& options = {});

}  // namespace loopbench::methods
