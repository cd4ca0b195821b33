/// The name that was probably meant by a misspelled one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace loopbench {

/// The closest known name if it is similar enough for a typing error, otherwise empty.
/// Distance: Damerau-Levenshtein (optimal string alignment). O(names * length^2).
std::string closest(const std::string& given, const std::vector<std::string>& known);

/// "; did you mean 'y'?" with the closest name of a file in the folder of one that does not exist;
/// empty if none is similar. O(files).
std::string similar_file(const std::filesystem::path& missing);

}  // namespace loopbench
