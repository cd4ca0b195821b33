/// Work spread over the cores, for results that do not depend on how it was spread.
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace loopbench {

/// Threads worth starting here, at least one.
inline std::size_t cores() {
  constexpr unsigned kMost = 16;
  return std::clamp(std::thread::hardware_concurrency(), 1u, kMost);
}

/// Poses or numbers below which starting a thread costs more than it saves.
inline constexpr std::size_t kWorthAThread = 32768;

/// Calls body(0) .. body(count - 1), each on a thread of its own. Throws what the first of them by
/// index threw, after all have ended.
template <class Body>
void in_parallel(std::size_t count, const Body& body) {
  std::vector<std::exception_ptr> thrown(count);
  const auto run = [&](std::size_t i) {
    try {
      body(i);
    } catch (...) {
      thrown[i] = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 1; i < count; ++i) threads.emplace_back(run, i);
    if (count > 0) run(0);
  }
  for (const std::exception_ptr& one : thrown) {
    if (one) std::rethrow_exception(one);
  }
}

/// Calls body(begin, end) for ranges that make up 0..count; one range when that is not worth a
/// thread. The body must give the same bits however the range is cut.
template <class Body>
void in_blocks(std::size_t count, const Body& body) {
  const std::size_t blocks = std::clamp<std::size_t>(count / kWorthAThread, 1, cores());
  in_parallel(blocks, [&](std::size_t k) { body(count * k / blocks, count * (k + 1) / blocks); });
}

}  // namespace loopbench
