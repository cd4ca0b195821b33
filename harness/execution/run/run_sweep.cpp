#include "harness/execution/run/run_sweep.hpp"

#include <exception>
#include <mutex>
#include <thread>

#include "harness/execution/run/oracle_method.hpp"
#include "harness/execution/run/run_cell.hpp"

namespace loopbench::harness {
namespace {

/// Distributes 0..count-1 over `jobs` threads. The first exception stops the others and is
/// rethrown.
void for_each_index(std::size_t count,
                    int jobs,
                    const StopRequests& stop,
                    const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> has_failed = false;
  std::exception_ptr first;
  std::mutex mutex;
  const auto worker = [&] {
    for (std::size_t i = next++; i < count && stop == 0 && !has_failed; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!first) first = std::current_exception();
        has_failed = true;
      }
    }
  };
  std::vector<std::jthread> threads;
  for (int job = 1; job < jobs; ++job) threads.emplace_back(worker);
  worker();
  threads.clear();  // joins the threads
  if (first) std::rethrow_exception(first);
}

}  // namespace

void run_sweep(const Sweep& sweep,
               const std::vector<Cell>& cells,
               const Catalogue& catalogue,
               Sequences& sequences,
               int jobs,
               const StopRequests& stop,
               const std::function<void(const CellResult&)>& finished) {
  // Check all inputs first, so that a wrong path in the last dataset is reported immediately.
  std::vector<const Cell*> first_of_dataset;
  for (const Cell& cell : cells) {
    if (first_of_dataset.empty() || first_of_dataset.back()->dataset != cell.dataset) {
      first_of_dataset.push_back(&cell);
    }
  }
  for_each_index(first_of_dataset.size(), jobs, stop, [&](std::size_t i) {
    sequences.get(*first_of_dataset[i]);
  });

  std::mutex mutex;
  for_each_index(cells.size(), jobs, stop, [&](std::size_t i) {
    const auto sequence = sequences.get(cells[i]);
    CellResult result = run_cell(cells[i], sweep, *sequence, catalogue);
    result.metadata = sequences.metadata(cells[i]);
    flag_trained_on_evaluated(result, sweep);
    if (jobs > 1) {  // the process also runs other cells
      result.cpu_seconds.clear();
      result.peak_memory = result.added_memory = result.allocations = std::nullopt;
    }
    sequences.done(cells[i]);
    const std::lock_guard lock(mutex);
    finished(result);
  });
}

}  // namespace loopbench::harness
