/// Parallel pipeline with results consumed in order.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "datasets/core/parallel.hpp"

namespace loopbench::rgbd {

/// Calls take(i, make(i)) for i = 0 .. count - 1. `make` runs on `workers` threads, at most `ahead`
/// items before the next item to be taken; `take` runs on the calling thread, in order. Results do
/// not depend on the number of threads. Waits for all threads and rethrows the first exception of
/// either.
template <class Item, class Make, class Take>
void ordered_pipeline(
    std::size_t count, std::size_t workers, std::size_t ahead, const Make& make, const Take& take) {
  std::mutex mutex;
  std::condition_variable changed;
  std::map<std::size_t, Item> finished;
  std::size_t next = 0;   // next item to be computed
  std::size_t taken = 0;  // number of items taken
  bool stop = false;
  std::exception_ptr error;
  const auto fail = [&] {
    const std::lock_guard lock(mutex);
    if (!error) error = std::current_exception();
    stop = true;
    changed.notify_all();
  };
  const auto work = [&] {
    try {
      while (true) {
        std::size_t item_index = 0;
        {
          std::unique_lock lock(mutex);
          changed.wait(lock, [&] { return stop || next >= count || next < taken + ahead; });
          if (stop || next >= count) return;
          item_index = next++;
        }
        Item item = make(item_index);
        const std::lock_guard lock(mutex);
        finished.emplace(item_index, std::move(item));
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
        changed.wait(lock, [&] { return stop || finished.contains(i); });
        if (stop) break;
        Item item = std::move(finished.extract(i).mapped());
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
  if (error) std::rethrow_exception(error);
}

}  // namespace loopbench::rgbd
