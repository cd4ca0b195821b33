/// "did you mean ...?" for names typed by people.
#pragma once

#include <string>
#include <vector>

namespace loopbench {

/// The closest known name when it is close enough to be a slip of the hand, else empty.
/// Distance: Damerau-Levenshtein (optimal string alignment). O(names * length^2).
std::string closest(const std::string& given, const std::vector<std::string>& known);

/// "no KIND is named 'x'", followed by the name that replaced it, the closest name ("did you mean
/// 'y'?") or, when nothing is close, all names.
std::string unknown_name(const std::string& kind,
                         const std::string& given,
                         const std::vector<std::string>& known);

}  // namespace loopbench
