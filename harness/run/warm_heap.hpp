/// Preparation of the heap of a new process.
#pragma once

namespace loopbench::harness {

/// In a worker: gives large blocks mappings of their own, which leave no holes in the heap when
/// they are freed. Cells would take their memory from these, page by page.
void keep_heap_compact();

/// In a cell. Every page that a forked process touches first costs as much as microseconds of
/// computing, which would be counted as time of fast methods. Lets malloc keep the memory it gets
/// and take the next megabytes from huge pages (Linux's transparent ones, where enabled), the first
/// of which is ready afterwards. Does nothing under a sanitizer.
void warm_heap();

}  // namespace loopbench::harness
