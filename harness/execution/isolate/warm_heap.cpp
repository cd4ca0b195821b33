#include "harness/execution/isolate/warm_heap.hpp"

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <utility>

namespace loopbench::harness {
namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20;    // [bytes]
constexpr std::size_t kReady = std::size_t{256} << 10;     // [bytes], less than most cells use
constexpr std::size_t kSmallPages = std::size_t{1} << 20;  // [bytes], at least, before huge ones
constexpr int kOwnMapping = 64 << 10;                      // [bytes]
constexpr int kMapped = 32 << 20;  // [bytes], larger blocks have mappings of their own
constexpr std::size_t kLargestHole = std::size_t{32} << 10;  // [bytes]
constexpr std::size_t kSmallestHole = 64;                    // [bytes]

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
constexpr bool kIsLibraryHeap = true;
#else
constexpr bool kIsLibraryHeap = false;
#endif

constexpr int kPopulate = 23;  ///< MADV_POPULATE_WRITE of Linux 5.14; older headers have no name

std::uintptr_t heap_end() { return reinterpret_cast<std::uintptr_t>(sbrk(0)); }

std::uintptr_t rounded_up(std::uintptr_t address, std::size_t size) {
  return (address + size - 1) / size * size;
}

}  // namespace

void HeapHoles::fill() {
  if constexpr (!kIsLibraryHeap) return;
  const std::uintptr_t top = heap_end() - mallinfo2().keepcost;  // of the unused end of the heap
  for (std::size_t size = kLargestHole; size >= kSmallestHole; size /= 2) {
    for (;;) {
      Block* const block = static_cast<Block*>(std::malloc(size));
      if (block == nullptr) return;
      if (reinterpret_cast<std::uintptr_t>(block) >= top) {
        std::free(block);
        break;
      }
      block->next = first_;
      first_ = block;
    }
  }
}

void HeapHoles::release() {
  while (first_ != nullptr) std::free(std::exchange(first_, first_->next));
}

void keep_heap_compact() { mallopt(M_MMAP_THRESHOLD, kOwnMapping); }

void warm_heap() {
  if constexpr (!kIsLibraryHeap) return;
  mallopt(M_MMAP_THRESHOLD, kMapped);  // the largest value that malloc accepts
  mallopt(M_TRIM_THRESHOLD, 8 * kMapped);
  // Volatile, so that the compiler does not leave it out.
  void* volatile const reserve = std::malloc(kMapped - kHugePage);
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto begin = reinterpret_cast<std::uintptr_t>(reserve) / page * page;
  std::free(reserve);  // the heap keeps the address space
  const std::uintptr_t first = rounded_up(begin + kSmallPages, kHugePage);
  const std::uintptr_t last = heap_end() / kHugePage * kHugePage;
  if (last <= first || begin > first) return;  // malloc does not use this heap
  madvise(reinterpret_cast<void*>(begin), kReady, kPopulate);
  madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
}

}  // namespace loopbench::harness
