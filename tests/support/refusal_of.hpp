/// Error messages of expected failures.
#pragma once

#include <exception>
#include <string>

namespace loopbench {

/// The text of the exception, an InputError or OptionError, that `act` throws; "" if it does not
/// throw.
template <class Act>
std::string refusal_of(Act act) {
  try {
    act();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

}  // namespace loopbench
