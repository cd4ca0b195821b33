/// Lines and names that fit a terminal.
#pragma once

#include <string>
#include <vector>

namespace loopbench::harness {

/// Width on a terminal: code points, not bytes.
std::size_t width(const std::string& text);

/// `text` broken at spaces, but not between a number and its unit, into lines of at most `columns`
/// characters; a longer word has a line of its own. 0 columns: one line.
std::vector<std::string> wrapped(const std::string& text, std::size_t columns);

/// `name`, and `text` from column `begin` on, broken at spaces into the width of `columns` (0: one
/// line). The text begins below a name that does not leave two spaces before it. Ends with a line
/// break.
std::string beside(const std::string& name,
                   const std::string& text,
                   std::size_t begin,
                   std::size_t columns);

/// `text` in at most `columns` (at least 3) characters: a path loses its first folders, other text
/// its middle, replaced by an ellipsis.
std::string shortened(const std::string& text, std::size_t columns);

/// The first `columns` characters of `text`, the last of them an ellipsis if something is missing.
std::string cut(const std::string& text, std::size_t columns);

}  // namespace loopbench::harness
