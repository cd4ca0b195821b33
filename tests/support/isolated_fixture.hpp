/// Sweeps in worker processes with a method that misbehaves.
#pragma once

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "harness/catalogue/load_sequence.hpp"
#include "harness/config/read_sweep.hpp"
#include "harness/execution/isolate/isolated_sweep.hpp"
#include "tests/support/tiny_catalogue.hpp"

namespace loopbench::isolated {

using namespace methods;
using namespace metrics;
using namespace harness;

enum class Deed {
  nothing,
  abort,
  kill,
  exit,
  hang,
  flood,
  own_process,
  leak,
  shell,
  daemon,
  unmapped
};
inline auto choices(Deed) {
  return std::array{std::pair{"nothing", Deed::nothing},
                    std::pair{"abort", Deed::abort},
                    std::pair{"kill", Deed::kill},
                    std::pair{"exit", Deed::exit},
                    std::pair{"hang", Deed::hang},
                    std::pair{"flood", Deed::flood},
                    std::pair{"own_process", Deed::own_process},
                    std::pair{"leak", Deed::leak},
                    std::pair{"shell", Deed::shell},
                    std::pair{"daemon", Deed::daemon},
                    std::pair{"unmapped", Deed::unmapped}};
}

struct Misbehaving final : Corrector {
  struct Options {
    Deed deed = Deed::nothing;
  };
  explicit Misbehaving(const Options& o) : options(o) {}
  Trajectory correct(const Problem& problem, Report& report) const override {
    std::vector<std::string> kept;
    switch (options.deed) {
      case Deed::abort:
        std::abort();
      case Deed::kill:
        raise(SIGKILL);
        break;
      case Deed::exit:
        _exit(7);
      case Deed::hang:
        for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
      case Deed::flood:
        for (int i = 0; i < 40; ++i) kept.emplace_back(std::size_t{50} << 20, 'x');
        break;
      case Deed::own_process: {
        static int cells_of_process = 0;
        report.count("cells of this process", ++cells_of_process);
        const std::chrono::duration<double> now =
            std::chrono::steady_clock::now().time_since_epoch();
        report.count("time", now.count());
        break;
      }
      case Deed::leak:
        new std::string(std::size_t{60} << 20, 'x');
        break;
      case Deed::shell:
        if (std::system("exec sleep 1000") == 0) break;
        break;
      case Deed::daemon:  // leaves its process group and its parent
        if (fork() == 0) {
          setsid();
          if (fork() == 0) {
            prctl(PR_SET_NAME, "isolate_stray");
            for (;;) pause();
          }
          _exit(0);
        }
        break;
      case Deed::unmapped: {  // memory of no process
        const int file = memfd_create("unmapped", 0);
        const std::string bytes(std::size_t{1} << 20, 'x');
        for (int i = 0; i < 500 && write(file, bytes.data(), bytes.size()) > 0; ++i) continue;
        break;
      }
      case Deed::nothing:
        break;
    }
    return problem.keyframes;
  }
  Options options;
};
template <class Visit>
void fields(Misbehaving::Options& o, Visit visit) {
  visit("deed", o.deed, "what it does");
}

class IsolatedFixture : public testing::Test {
 protected:
  std::vector<CellResult> run(const std::string& text, int jobs) {
    const Sweep sweep = parse_sweep(text, "c.yaml", known_);
    return run(sweep, cells(sweep, seeded(sweep, known_), ""), jobs);
  }
  std::vector<CellResult> run(const Sweep& sweep, const std::vector<Cell>& planned, int jobs) {
    std::vector<CellResult> out;
    const StopRequests stop = 0;
    run_isolated(sweep, planned, known_, {}, jobs, sandbox_, stop, [&](const CellResult& result) {
      out.push_back(result);
    });
    std::ranges::sort(out, {}, [](const CellResult& r) { return r.cell.index; });
    return out;
  }

  SandboxOptions sandbox_;
  Catalogue known_ = [] {
    Catalogue out = tiny::catalogue();
    out.methods.push_back(method<Misbehaving>("mis", "misbehaves"));
    return out;
  }();
};

}  // namespace loopbench::isolated
