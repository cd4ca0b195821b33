#include "harness/commands/huge_pages.hpp"

#include <cstdlib>

#include "harness/base/sanitized.hpp"

#if defined(__GLIBC__) && !defined(LOOPBENCH_SANITIZED)

#include <sys/mman.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>

namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20;  // [bytes]
constinit std::atomic<bool> uses_huge_pages{false};

/// Lets the kernel back the block by huge pages, where it has whole ones.
void* advised(void* block, std::size_t size) {
  if (size < 2 * kHugePage || block == nullptr || !uses_huge_pages.load(std::memory_order_relaxed))
    return block;
  const auto address = reinterpret_cast<std::uintptr_t>(block);
  const std::uintptr_t first = (address + kHugePage - 1) / kHugePage * kHugePage;
  const std::uintptr_t last = (address + size) / kHugePage * kHugePage;
  const int saved = errno;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
  errno = saved;
  return block;
}

}  // namespace

// NOLINTBEGIN: glibc provides this name for replacement
extern "C" {
void* __libc_malloc(std::size_t size);
void* malloc(std::size_t size) noexcept { return advised(__libc_malloc(size), size); }
}
// NOLINTEND

namespace loopbench::harness {

void use_huge_pages() { uses_huge_pages.store(true, std::memory_order_relaxed); }

}  // namespace loopbench::harness

#else

namespace loopbench::harness {

void use_huge_pages() {}

}  // namespace loopbench::harness

#endif
