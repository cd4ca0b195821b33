/// The world is wrong: a file, a config, a command line. Ends a run with exit code 2.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace loopbench {

/// Its text reads `where: what was found and what was expected`.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A part that this build was made without is needed. Ends a run with exit code 4.
class MissingPart : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// `file: what`, or `file:line: what` when line > 0.
inline InputError input_error(const std::string& file, std::size_t line, const std::string& what) {
  std::string text = file;
  if (line > 0) text.append(":").append(std::to_string(line));
  return InputError(text.append(": ").append(what));
}

}  // namespace loopbench
