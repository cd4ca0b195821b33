/// Error messages of expected failures.
#pragma once

#include <exception>
#include <string>

namespace loopbench {

/// The text of the exception, an InputError or OptionError unless an `Error` is given, that `act`
/// throws; "" if it does not throw.
template <class Error = std::exception, class Act>
std::string refusal_of(Act act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace loopbench
