/// Preparation of the heap of a new process.
#pragma once

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>

#include "harness/base/sanitized.hpp"

namespace loopbench::harness {

inline constexpr std::size_t kHugePage = std::size_t{2} << 20;  // [bytes]
inline constexpr int kOwnMapping = 64 << 10;                    // [bytes]
inline constexpr int kMapped = 32 << 20;  // [bytes], larger blocks have mappings of their own

/// In a worker: gives large blocks mappings of their own, which leave no holes in the heap when
/// they are freed. Cells would take their memory from these, page by page.
inline void keep_heap_compact() { mallopt(M_MMAP_THRESHOLD, kOwnMapping); }

/// In a cell. Every page that a forked process touches first costs as much as microseconds of
/// computing, which would be counted as time of fast methods. Lets malloc keep the memory it gets
/// and take the next megabytes from huge pages (Linux's transparent ones, where enabled), the first
/// of which is ready afterwards. Does nothing under a sanitizer.
inline void warm_heap() {
#ifndef LOOPBENCH_SANITIZED
  mallopt(M_MMAP_THRESHOLD, kMapped);  // the largest value that malloc accepts
  mallopt(M_TRIM_THRESHOLD, 8 * kMapped);
  // An unused block up to the next huge page, so that the blocks after it are in huge pages.
  const auto end = reinterpret_cast<std::uintptr_t>(sbrk(0));
  const std::uintptr_t first = (end + kHugePage - 1) / kHugePage * kHugePage;
  // Volatile, so that the compiler does not leave out allocations.
  [[maybe_unused]] void* volatile const unused = std::malloc(first - end);
  void* volatile const reserve = std::malloc(kMapped - kHugePage);
  std::free(reserve);  // the heap keeps the address space
  const std::uintptr_t last = reinterpret_cast<std::uintptr_t>(sbrk(0)) / kHugePage * kHugePage;
  if (last <= first) return;  // malloc does not use this heap
  madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
  *reinterpret_cast<volatile char*>(first + kHugePage / 2) = 0;  // free memory
#endif
}

}  // namespace loopbench::harness
