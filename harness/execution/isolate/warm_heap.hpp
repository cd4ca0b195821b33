/// Preparation of the heap of a new process.
#pragma once

namespace loopbench::harness {

/// In a worker: gives large blocks mappings of their own, which leave no holes in the heap when
/// they are freed. Cells would take their memory from these, page by page.
void keep_heap_compact();

/// In a worker: occupies the free blocks between used ones. Memory that a cell takes from there is
/// copied or cleared page by page, each for more than a microsecond; memory at the end of the heap
/// is ready after warm_heap(). Does nothing under a sanitizer.
class HeapHoles {
 public:
  HeapHoles() = default;
  ~HeapHoles() { release(); }
  HeapHoles(const HeapHoles&) = delete;
  HeapHoles& operator=(const HeapHoles&) = delete;

  /// O(size of the holes).
  void fill();
  void release();

 private:
  struct Block {
    Block* next;
  };
  Block* first_ = nullptr;
};

/// In a cell. Every page that a forked process touches first costs as much as microseconds of
/// computing, which would be counted as time of fast methods. Lets malloc keep the memory it gets,
/// makes the next quarter of a megabyte ready at once, and takes the memory after a few megabytes
/// from huge pages (Linux's transparent ones, where enabled). Does nothing under a sanitizer.
void warm_heap();

}  // namespace loopbench::harness
