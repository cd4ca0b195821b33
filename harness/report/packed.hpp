/// Columns of numbers, small enough to lie in a page by the thousand.
#pragma once

#include <string>
#include <vector>

namespace loopbench {

/// The JSON object {lo, step, b}: value = lo + step * word, words of 16 bits little endian in
/// base64; 65535 is no number. Error at most half a step: 1/131068 of the range, far below a pixel.
std::string packed(const std::vector<double>& values);

/// Places 0..count-1 thinned evenly to at most `most`, both ends kept.
std::vector<std::size_t> thinned_places(std::size_t count, std::size_t most);

}  // namespace loopbench
