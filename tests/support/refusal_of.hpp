/// What a refusal says.
#pragma once

#include <exception>
#include <string>

namespace loopbench {

/// The text of the exception, an InputError or OptionError, that `act` throws; "" when it does not.
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
