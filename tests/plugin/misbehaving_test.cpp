/// A plugin that aborts, loops, exits and exhausts memory, run through the command line.
#include <gtest/gtest.h>

#include "harness/catalogue/catalogue.hpp"
#include "harness/catalogue/libraries.hpp"
#include "harness/store/read.hpp"
#include "tests/support/command.hpp"

namespace loopbench {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

TEST(Misbehaving, APluginCostsItsOwnCellsOnly) {
  TemporaryFolder folder;
  folder.file("c.yaml",
              "datasets: [{dataset: simulated, path: room, keyframes: 40}]\n"
              "methods: [raw, aborts, loops, exits, floods, uniform]\nmetrics: [ate]\n"
              "limits: {seconds: 10, memory: 700MiB}\n");
  const std::string line = "run c.yaml --out r --plugin '" LOOPBENCH_MISBEHAVING "'";
  const CommandResult result = loopbench_command(line, folder);
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_NE(result.out.find("6 of 6 cells done, 4 failed"), std::string::npos) << result.out;
  const std::vector<CellRecord> cells = read_cells(folder.path() / "r");
  ASSERT_EQ(cells.size(), 6u);
  const Status statuses[] = {Status::ok,
                             Status::crashed,
                             Status::timeout,
                             Status::crashed,
                             Status::out_of_memory,
                             Status::ok};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(cells[i].status, statuses[i]) << cells[i].why;
  EXPECT_EQ(cells[1].signal, "SIGABRT");
  EXPECT_EQ(cells[2].signal, "SIGKILL");

  const CommandResult again = loopbench_command(line, folder);
  EXPECT_EQ(again.exit_code, 1) << "failures are kept as failures";
  EXPECT_NE(again.out.find("(6 of them in earlier runs), 4 failed"), std::string::npos)
      << again.out;
}

TEST(Misbehaving, ItsVersionCoversTheLibrariesThatItBrings) {
  const Catalogue known = catalogue({LOOPBENCH_MISBEHAVING});
  const std::vector<std::filesystem::path> brought = plugin_libraries(LOOPBENCH_MISBEHAVING);
  ASSERT_EQ(brought.size(), 1u);
  EXPECT_EQ(brought[0].filename(), "libcompanion.so");
  EXPECT_NE(known.versions.at("method aborts").find(", libcompanion.so "), std::string::npos);
}

}  // namespace
}  // namespace loopbench
