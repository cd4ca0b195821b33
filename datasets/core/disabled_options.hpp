/// Rejects options that have no effect because of another option.
#pragma once

#include <initializer_list>
#include <string>

#include "datasets/core/params.hpp"

namespace loopbench {

/// Throws OptionError with `message` about the option unless the condition holds.
inline void require_option(bool condition, const std::string& option, const std::string& message) {
  if (!condition) throw OptionError(option, option + ": " + message);
}

/// Throws OptionError if one of `options` is `given` although it has no effect with this `value` of
/// the option `other`. `expected` lists the values of that option with which it has one.
inline void reject_disabled(const Params& given,
                            std::initializer_list<const char*> options,
                            const std::string& other,
                            const std::string& value,
                            const std::string& expected) {
  for (const char* option : options) {
    if (!given.contains(option)) continue;
    throw OptionError(option,
                      std::string(option) + ": has no effect with " + other + " = " + value +
                          ", expected " + other + " = " + expected);
  }
}

/// Throws OptionError if an option whose name starts with `prefix` is `given` although the option
/// `file`, which it depends on, is not set.
inline void reject_disabled_by_missing(const Params& given,
                                       const std::string& prefix,
                                       const std::string& file) {
  for (const auto& [option, value] : given) {
    if (!option.starts_with(prefix)) continue;
    throw OptionError(option, option + ": has no effect without " + file + ", which is empty");
  }
}

}  // namespace loopbench
