/// Work done out of order on all cores, taken in order by one.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "datasets/core/parallel.hpp"

namespace loopbench {

/// take(i, make(i)) for i = 0 .. count - 1: `make` on `workers` threads, no more than `ahead` items
/// before the one that is taken next; `take` on the caller's thread, in order. Results do not
/// depend on the number of threads. Throws the first of what either threw, after all have ended.
template <class Item, class Make, class Take>
void ordered_pipeline(
    std::size_t count, std::size_t workers, std::size_t ahead, const Make& make, const Take& take) {
  std::mutex mutex;
  std::condition_variable changed;
  std::map<std::size_t, Item> made;
  std::size_t next = 0;   // to be made
  std::size_t taken = 0;  // items taken so far
  bool stop = false;
  std::exception_ptr thrown;
  const auto fail = [&] {
    const std::lock_guard lock(mutex);
    if (!thrown) thrown = std::current_exception();
    stop = true;
    changed.notify_all();
  };
  const auto work = [&] {
    try {
      while (true) {
        std::size_t mine = 0;
        {
          std::unique_lock lock(mutex);
          changed.wait(lock, [&] { return stop || next >= count || next < taken + ahead; });
          if (stop || next >= count) return;
          mine = next++;
        }
        Item item = make(mine);
        const std::lock_guard lock(mutex);
        made.emplace(mine, std::move(item));
        changed.notify_all();
      }
    } catch (...) {
      fail();
    }
  };
  {
    std::vector<std::jthread> threads;
    for (std::size_t k = 0; k < workers; ++k) threads.emplace_back(work);
    try {
      for (std::size_t i = 0; i < count; ++i) {
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return stop || made.contains(i); });
        if (stop) break;
        Item item = std::move(made.extract(i).mapped());
        lock.unlock();
        take(i, std::move(item));
        lock.lock();
        ++taken;
        changed.notify_all();
      }
    } catch (...) {
      fail();
    }
  }
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace loopbench
