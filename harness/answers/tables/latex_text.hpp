/// Texts for LaTeX.
#pragma once

#include <string>

namespace loopbench::harness {

inline constexpr const char* kDagger = "\u2020";

/// Escaped, on one line; \u00b1 and kDagger as commands.
std::string escaped_latex(const std::string& text);

/// Escaped, for a paragraph: names and paths can be broken after _, / and =.
std::string breakable(const std::string& text);

/// Width in Computer Modern of 8 pt, rounded up [pt].
double latex_width(const std::string& text);

}  // namespace loopbench::harness
