/// Sweeps with programs as methods.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/store/read.hpp"
#include "tests/support/command.hpp"

namespace loopbench::test {

/// One simulated sequence, `raw` and programs; checks that no temporary files are left.
class ProgramSweep : public testing::Test {
 protected:
  ProgramSweep() {
    std::filesystem::create_directory(tmp_);
    setenv("TMPDIR", tmp_.c_str(), 1);
  }
  ~ProgramSweep() override {
    unsetenv("TMPDIR");
    EXPECT_TRUE(std::filesystem::is_empty(tmp_)) << "files of programs are left";
  }

  /// Runs a sweep of one simulated sequence with these method entries; returns its cells.
  std::vector<harness::CellRow> cells(const std::string& entries,
                                      const std::string& settings = "",
                                      const std::string& options = "") {
    folder_.file(
        "c.yaml",
        "datasets: [{dataset: simulated, path: room, keyframes: 40}]\nmethods:\n  - raw\n" +
            entries + "metrics: [ate]\ntimes: keyframes\n" + settings);
    ran_ = loopbench_command("run c.yaml --out r -j 2" + options, folder_);
    return harness::read_cells(folder_.path() / "r");
  }

  static std::string entry(const std::string& label, const std::string& run) {
    return "  - {method: command, label: " + label + ", run: " + run + "}\n";
  }

  static std::string notes(const harness::CellRow& cell) {
    std::string out;
    for (const std::string& note : cell.notes) out += note + "\n";
    return out;
  }

  TemporaryFolder folder_;
  const std::filesystem::path tmp_ = folder_.path() / "tmp";
  CommandResult ran_;
};

}  // namespace loopbench::test
