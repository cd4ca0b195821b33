/// Errors in user input: a file, a config or the command line. The program exits with code 2.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace loopbench {

/// Message format: `where: what was found, what was expected`.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The build lacks a required part. The program exits with code 4.
class MissingPart : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// No error: a program that declines a problem, a metric that a sequence does not define.
class Declined : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Message `file: what`, or `file:line: what` if line > 0.
inline InputError input_error(const std::string& file, std::size_t line, const std::string& what) {
  std::string text = file;
  if (line > 0) text.append(":").append(std::to_string(line));
  return InputError(text.append(": ").append(what));
}

}  // namespace loopbench
