/// Sweeps in worker processes.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "harness/catalogue/load_sequence.hpp"
#include "harness/config/read_sweep.hpp"
#include "harness/run/isolated_sweep.hpp"
#include "tests/support/tiny_catalogue.hpp"

namespace loopbench::isolated {

using namespace methods;
using namespace metrics;
using namespace harness;

/// Counts the cells of its process.
struct CountsCells final : Corrector {
  struct Options {};
  explicit CountsCells(const Options&) {}
  Trajectory correct(const Problem& problem, Report& report) const override {
    static int cells_of_process = 0;
    report.count("cells of this process", ++cells_of_process);
    return problem.keyframes;
  }
};
template <class Visit>
void fields(CountsCells::Options&, Visit) {}

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
    out.methods.push_back(method<CountsCells>("counts_cells", ""));
    return out;
  }();
};

}  // namespace loopbench::isolated
