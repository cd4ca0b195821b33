/// Messages on standard error.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <utility>

namespace loopbench::harness {

/// Prints to standard error. Unlike fmt::print, it does not throw if that is closed or full: a
/// message that nobody can read must not fail the command.
template <class... Values>
void print_error(fmt::format_string<Values...> text, Values&&... values) {
  std::fputs(fmt::format(text, std::forward<Values>(values)...).c_str(), stderr);
}

}  // namespace loopbench::harness
