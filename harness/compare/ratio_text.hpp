/// Parts of verdicts: ratios in words.
#pragma once

#include <string>
#include <vector>

#include "harness/compare/compare.hpp"

namespace loopbench::harness {

/// "a, b and c"; of more than four names the first three and "5 others".
std::string joined_names(std::vector<std::string> names, const char* last = " and ");

/// "12.3 % below raw [8.1, 15.2]", for a score with a target "12.3 % closer to 1 than raw".
std::string ratio_text(const Ratio& ratio, const std::string& other, const Comparison& c);

/// Whether a ratio is better than 1 by more than a relevant difference.
bool is_gain(double ratio, const Comparison& c);

/// ", all of it on sparse (20.0 %)", ", but worse on city": what a ratio hides.
std::string sequences_text(const Ratio& ratio, const Comparison& c);

/// "7 are needed": observations for a significant difference.
std::string needed_text(const Comparison& c);

}  // namespace loopbench::harness
