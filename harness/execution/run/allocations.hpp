/// How often the program asked for memory.
#pragma once

#include <cstdint>
#include <optional>

namespace loopbench {

/// Calls of malloc, calloc, realloc and their aligned kin by all threads so far: those behind
/// `new`, inside Eigen and in C libraries alike. Nothing where they are not counted: under
/// sanitizers and outside glibc. A program that links this has its own malloc, which counts and
/// calls glibc's; that costs about a nanosecond.
std::optional<std::int64_t> allocations();

}  // namespace loopbench
