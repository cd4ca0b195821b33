// A plugin that hangs when it is made, has threads, and changes what it must not. The zoo has what
// ends its process.
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cfenv>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include "companion.hpp"
#include "harness/sweep/catalogue/plugin.hpp"

using namespace loopbench;
using namespace loopbench::methods;

namespace {

struct HangsWhenMade final : Corrector {
  using Options = NoOptions;
  explicit HangsWhenMade(const Options&) {
    for (std::atomic<unsigned> turns = 0;; ++turns) {
    }
  }
  Trajectory correct(const Problem& problem, Report&) const override { return problem.keyframes; }
};

struct ThrowsWhenMade final : Corrector {
  using Options = NoOptions;
  explicit ThrowsWhenMade(const Options&) { throw std::runtime_error("no licence"); }
  Trajectory correct(const Problem& problem, Report&) const override { return problem.keyframes; }
};

/// Holds 400 MiB in a file in memory, which is not mapped.
Trajectory fill_memory_file(const Problem& problem) {
  const int file = memfd_create("x", 0);
  const std::vector<char> block(std::size_t{1} << 20, 'x');
  for (int i = 0; i < 400; ++i) {
    if (write(file, block.data(), block.size()) < 0) throw std::runtime_error("cannot write");
  }
  sleep(1);
  return problem.keyframes;
}

/// A thread that starts when the plugin is loaded and does all work, as the pool of OpenMP.
class Pool {
 public:
  Pool() : thread_([this] { work(); }) { thread_.detach(); }
  void run() {
    std::unique_lock lock(mutex_);
    wanted_ = true;
    changed_.notify_all();
    changed_.wait(lock, [this] { return !wanted_; });
  }

 private:
  void work() {
    for (;;) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return wanted_; });
      wanted_ = false;
      changed_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  bool wanted_ = false;
  std::thread thread_;
};
Pool& pool = *new Pool;  // NOLINT: used by its thread until the process ends

std::vector<metrics::Score> rounds_upward(const metrics::Evaluation&, const NoOptions&) {
  std::fesetround(FE_UPWARD);
  return {};
}

std::vector<metrics::Score> moves_estimate(const metrics::Evaluation& evaluation,
                                           const NoOptions&) {
  for (const StampedPose& pose : evaluation.estimate) {
    const_cast<StampedPose&>(pose).world_from_body.translation.x() += 5.0;
  }
  return {};
}

}  // namespace

LOOPBENCH_PLUGIN(method("exits",
                        "ends the process as if all were well",
                        [](const Problem&) -> Trajectory { std::exit(exit_code_of_success()); }),
                 method("pooled",
                        "works in a thread of its own",
                        [](const Problem& problem) {
                          pool.run();
                          return problem.keyframes;
                        }),
                 method("fills_memory_file", "holds 400 MiB", fill_memory_file),
                 method<ThrowsWhenMade>("throws_when_made", "throws in its constructor"),
                 method<HangsWhenMade>("hangs_when_made", "never returns from its constructor"),
                 metric<NoOptions>("rounds_upward", "leaves another rounding", rounds_upward),
                 metric<NoOptions>("moves_estimate", "writes through const", moves_estimate))
