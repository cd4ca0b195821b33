/// "did you mean ...?" suggestions for misspelled names.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/params.hpp"
#include "datasets/files/closest_name.hpp"

namespace loopbench::harness {

/// "no KIND is named 'x'", followed by the closest name ("did you mean 'y'?") or, without a similar
/// name, the list of all names, if there are any.
std::string unknown_name(const std::string& kind,
                         const std::string& given,
                         const std::vector<std::string>& known);

/// The message, with the closest of the words that were expected, or of further names that can take
/// the place of an option ("did you mean 'y'?").
std::string with_guess(const OptionError& error, const std::vector<std::string>& further = {});

}  // namespace loopbench::harness
