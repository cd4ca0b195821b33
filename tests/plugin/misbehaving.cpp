// A plugin that crashes, hangs, exits and exhausts memory; only its own cells must fail.
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include "companion.hpp"
#include "harness/plugin/plugin.hpp"

using namespace loopbench;
using namespace loopbench::methods;

namespace {

struct NoOptions {};
template <class Visit>
void fields(NoOptions&, Visit) {}

template <class Deed>
struct Bad final : Corrector {
  using Options = NoOptions;
  explicit Bad(const Options&) {}
  Trajectory correct(const Problem& problem, Report&) const override {
    Deed{}();
    return problem.keyframes;
  }
};

struct Aborts {
  void operator()() const { std::abort(); }
};
struct Loops {
  void operator()() const {
    for (std::atomic<unsigned> turns = 0;; ++turns) {
    }
  }
};
struct Exits {
  void operator()() const { std::exit(exit_code_of_success()); }
};
struct Floods {
  void operator()() const {
    std::vector<std::unique_ptr<char[]>> kept;
    constexpr std::size_t kBlock = std::size_t{64} << 20;
    for (int i = 0; i < 64; ++i) {  // at most 4 GiB if the limit does not work
      kept.push_back(std::make_unique<char[]>(kBlock));
      std::memset(kept.back().get(), i, kBlock);
    }
  }
};

}  // namespace

LOOPBENCH_PLUGIN(method<Bad<Aborts>>("aborts", "calls abort"),
                 method<Bad<Loops>>("loops", "never returns"),
                 method<Bad<Exits>>("exits", "ends the process as if all were well"),
                 method<Bad<Floods>>("floods", "takes all memory"))
