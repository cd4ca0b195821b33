/// Parallel loops whose results do not depend on the number of threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace loopbench {

/// Number of hardware threads, limited to 1..16.
inline std::size_t hardware_threads() {
  constexpr unsigned kMost = 16;
  static const std::size_t out = std::clamp(std::thread::hardware_concurrency(), 1u, kMost);
  return out;  // asking the system takes longer than a small loop
}

/// Minimum number of elements for which an additional thread pays off.
inline constexpr std::size_t kMinItemsPerThread = 32768;

/// Calls body(0) .. body(count - 1), each on its own thread, and waits for all. Rethrows the
/// exception with the lowest index.
template <class Body>
void parallel_invoke(std::size_t count, const Body& body) {
  std::vector<std::exception_ptr> errors(count);
  const auto run = [&](std::size_t i) {
    try {
      body(i);
    } catch (...) {
      errors[i] = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 1; i < count; ++i) threads.emplace_back(run, i);
    if (count > 0) run(0);
  }
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

/// Calls body(0) .. body(count - 1) on at most as many threads as there are cores, each on the next
/// that is free. Rethrows an exception after all have ended.
template <class Body>
void parallel_for_tasks(std::size_t count, const Body& body) {
  std::atomic<std::size_t> next = 0;
  parallel_invoke(std::min(count, hardware_threads()), [&](std::size_t) {
    for (std::size_t i = 0; (i = next++) < count;) body(i);
  });
}

/// Calls body(begin, end) in parallel for ranges that partition 0..count; small counts use a single
/// range. The result of `body` must not depend on the partition.
template <class Body>
void parallel_for_blocks(std::size_t count, const Body& body) {
  const std::size_t blocks =
      std::clamp<std::size_t>(count / kMinItemsPerThread, 1, hardware_threads());
  parallel_invoke(blocks,
                  [&](std::size_t k) { body(count * k / blocks, count * (k + 1) / blocks); });
}

}  // namespace loopbench
