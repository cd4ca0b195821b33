/// Error messages of expected failures.
#pragma once

#include <gtest/gtest.h>

#include <exception>
#include <string>

namespace loopbench {

/// The text of the exception that `act` throws, for example an InputError or OptionError; "" if it
/// does not throw. Exceptions of other types than `Error` pass.
template <class Error = std::exception, class Act>
std::string refusal_of(Act act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// The same; the test fails if `act` does not throw.
template <class Error, class Act>
std::string required_refusal_of(Act act) {
  const std::string out = refusal_of<Error>(act);
  EXPECT_NE(out, "") << "nothing thrown";
  return out;
}

}  // namespace loopbench
