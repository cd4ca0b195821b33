#include "harness/commands/run_messages.hpp"

#include <fmt/format.h>

#include "harness/commands/commands.hpp"
#include "harness/text/print_error.hpp"
#include "harness/text/printable.hpp"

namespace loopbench::harness {

void print_plan(const Sweep& sweep, const std::vector<Cell>& planned) {
  for (const Cell& cell : planned) {
    const std::string repeat = cell.repeat > 0 ? fmt::format(" (repeat {})", cell.repeat) : "";
    fmt::print("{:5}  {}{} / {}\n",
               cell.index,
               printable(sweep.datasets[cell.dataset].label),
               repeat,
               printable(sweep.methods[cell.method].label));
  }
  fmt::print("{} cells, {} metrics each\n", planned.size(), sweep.metrics.size());
}

int report_bad_inputs(const std::vector<std::string>& reasons) {
  if (reasons.empty()) return kExitOk;
  for (const std::string& reason : reasons) {
    print_error("loopbench: {}\n", printable(reason));
  }
  print_error("loopbench: {} of the sequences above cannot be loaded; their cells would fail\n",
              reasons.size());
  return kExitBadInput;
}

void report_damage(const Resumed& resumed, const std::filesystem::path& store) {
  if (resumed.damaged.empty()) return;
  print_error(
      "loopbench: {}: damaged cells are recomputed: {}{}\n",
      store.string(),
      printable(resumed.damaged.front()),
      resumed.damaged.size() == 1 ? "" : fmt::format(" and {} more", resumed.damaged.size() - 1));
}

}  // namespace loopbench::harness
