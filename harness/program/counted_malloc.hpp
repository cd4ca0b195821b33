/// Replaces malloc by a counting wrapper around glibc's, which costs about a nanosecond. Linked
/// into the program only, so that a library does not replace the malloc of whoever embeds it.
#pragma once

#include "harness/execution/run/allocations.hpp"

namespace loopbench::harness {

/// Counts the calls of malloc, calloc, realloc and the aligned variants by all threads so far,
/// including those by `new`, Eigen and C libraries. Null under sanitizers and outside glibc, where
/// they are not counted.
AllocationCounter counted_malloc();

/// From now on, asks for transparent huge pages for blocks from malloc of 4 MiB and more: for
/// commands that read large files, where the first touch of every page takes a tenth of the time.
/// Not for sweeps, whose cells have limits of memory. Does nothing where malloc is not replaced.
void use_huge_pages();

}  // namespace loopbench::harness
