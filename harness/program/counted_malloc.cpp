#include "harness/program/counted_malloc.hpp"

#include <cstdlib>

#include "harness/execution/run/sanitized.hpp"

#if defined(__GLIBC__) && !defined(LOOPBENCH_SANITIZED)

#include <sys/mman.h>

#include <algorithm>
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

/// A thread-local counter avoids an atomic addition, which would cost as much as malloc itself.
struct alignas(64) AllocationCount {
  std::atomic<std::int64_t> value{0};
};
constexpr int kAllocationCounts = 4096;  // the last is shared by all further threads
constinit AllocationCount allocation_counts[kAllocationCounts];
constinit std::atomic<int> allocating_threads{0};
constinit thread_local int allocation_slot = -1;

void count_allocation() {
  if (allocation_slot < 0) {
    const int slot = allocating_threads.fetch_add(1, std::memory_order_relaxed);
    allocation_slot = slot < kAllocationCounts ? slot : kAllocationCounts - 1;
  }
  std::atomic<std::int64_t>& count = allocation_counts[allocation_slot].value;
  if (allocation_slot == kAllocationCounts - 1) {
    count.fetch_add(1, std::memory_order_relaxed);
  } else {
    count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }
}

}  // namespace

// NOLINTBEGIN: glibc provides these names for replacement
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) noexcept {
  count_allocation();
  return advised(__libc_malloc(size), size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  count_allocation();
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) noexcept {
  count_allocation();
  return __libc_realloc(block, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  count_allocation();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  const bool is_power = alignment != 0 && (alignment & (alignment - 1)) == 0;
  if (!is_power || alignment % sizeof(void*) != 0) return EINVAL;
  count_allocation();
  void* found = __libc_memalign(alignment, size);
  if (found == nullptr) return ENOMEM;
  *block = found;
  return 0;
}
}
// NOLINTEND

namespace loopbench::harness {

AllocationCounter counted_malloc() {
  return [] {
    const int threads = allocating_threads.load(std::memory_order_relaxed);
    std::int64_t out = 0;
    for (int i = 0; i < std::min(threads, kAllocationCounts); ++i) {
      out += allocation_counts[i].value.load(std::memory_order_relaxed);
    }
    return out;
  };
}

void use_huge_pages() { uses_huge_pages.store(true, std::memory_order_relaxed); }

}  // namespace loopbench::harness

#else

namespace loopbench::harness {

AllocationCounter counted_malloc() { return nullptr; }

void use_huge_pages() {}

}  // namespace loopbench::harness

#endif
