/// Sweeps in worker processes.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "harness/sweep/catalogue/load_sequence.hpp"
#include "harness/sweep/config/read_sweep.hpp"
#include "harness/sweep/run/isolated_sweep.hpp"
#include "tests/support/tiny_catalogue.hpp"

namespace loopbench::tiny {

/// `line`, after a deed of the dataset.
inline DatasetEntry line_after(const std::string& name, const std::function<void()>& deed) {
  return dataset<LineOptions>(name, "", [=](const LineOptions& options, const DataRoot& root) {
    deed();
    return load_line(options, root);
  });
}

class IsolatedFixture : public testing::Test {
 protected:
  std::vector<CellResult> run(const std::string& text, int jobs) {
    const Sweep sweep = parse_sweep(text, "c.yaml", known_);
    return run(sweep, cells(sweep, seeded(sweep, known_), ""), jobs);
  }
  /// Expects `count` cells, all ok.
  void expect_ok(const std::string& text, int jobs, std::size_t count) {
    const std::vector<CellResult> results = run(text, jobs);
    ASSERT_EQ(results.size(), count);
    for (const CellResult& result : results) EXPECT_EQ(result.status, Status::ok) << result.why;
  }
  std::vector<CellResult> run(const Sweep& sweep, const std::vector<Cell>& planned, int jobs) {
    results_.clear();
    const StopRequests stop = 0;
    const DataRoot root;
    run_isolated({sweep, planned, known_, root, sandbox_}, jobs, stop, [&](const CellResult& r) {
      results_.push_back(r);
    });
    std::ranges::sort(results_, {}, [](const CellResult& r) { return r.cell.index; });
    return results_;
  }

  std::vector<CellResult> results_;  // also of a run that threw
  SandboxOptions sandbox_;
  Catalogue known_ = catalogue();
};

}  // namespace loopbench::tiny
