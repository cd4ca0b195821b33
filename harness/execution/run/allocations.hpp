/// Number of memory allocations of the program.
#pragma once

#include <cstdint>
#include <optional>

namespace loopbench::harness {

/// Calls of malloc, calloc, realloc and the aligned variants by all threads so far, including those
/// by `new`, Eigen and C libraries. nullopt under sanitizers and outside glibc, where they are not
/// counted. A program that links this replaces malloc by a counting wrapper around glibc's, which
/// costs about a nanosecond.
std::optional<std::int64_t> allocations();

}  // namespace loopbench::harness
