#include "harness/commands/check_history.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>

#include "datasets/core/error.hpp"
#include "harness/base/write_file.hpp"
#include "harness/commands/history_chart.hpp"
#include "harness/compare/baseline_file.hpp"
#include "harness/compare/snapshot.hpp"
#include "harness/report/draw.hpp"
#include "harness/tables/gate_table.hpp"

namespace loopbench::harness {
namespace {

/// "changed: dual (2 cells), motion_drift (40 cells)", or empty without findings in cells.
std::string changed_methods(const GateReport& report,
                            const StoredBaseline& before,
                            const StoredBaseline& now) {
  std::map<std::string, std::string> method_of;  // by name of the cell
  for (const StoredBaseline* const each : {&before, &now}) {
    for (const GateCell& cell : each->baseline.snapshot.cells) method_of[name(cell)] = cell.method;
  }
  std::map<std::string, std::set<std::string>> cells;
  for (const Finding& finding : report.findings) {
    const auto method = method_of.find(finding.cell);
    if (method != method_of.end()) cells[method->second].insert(finding.cell);
  }
  std::string out;
  for (const auto& [method, changed] : cells) {
    out += fmt::format("{}{} ({})",
                       out.empty() ? "changed: " : ", ",
                       method,
                       counted_findings(changed.size(), "cell"));
  }
  return out;
}

/// Whether something changed.
bool print_step(const StoredBaseline& before, const StoredBaseline& now) {
  GateReport report;
  std::vector<std::string> first_notes =
      different_definitions(before.baseline.snapshot, now.baseline.snapshot);
  try {
    report = changes(before.baseline, now.baseline.snapshot);
  } catch (const InputError& error) {
    first_notes.push_back(std::string("values are not compared: ") + error.what());
  }
  const std::string title = described(before) + " -> " + described(now);
  if (first_notes.empty() && report.findings.empty()) {
    fmt::print("### {}\n\n- no change\n\n", one_line(title));
    return false;
  }
  if (const std::string changed = changed_methods(report, before, now); !changed.empty()) {
    first_notes.push_back(changed);
  }
  report.notes.insert(report.notes.begin(), first_notes.begin(), first_notes.end());
  fmt::print("{}\n", findings_markdown(report, title));
  return true;
}

}  // namespace

void check_history(const HistoryOptions& options) {
  if (options.files.size() < 2) throw InputError("--history: expected at least two baselines");
  if (!options.chart.empty() && !is_figure_name(options.chart)) {
    throw InputError(fmt::format("--chart: {}: expected a name that ends in {}",
                                 options.chart.string(),
                                 fmt::join(kFigureFormats, ", ")));
  }
  reject_overwriting(options.files, options.chart);
  std::vector<StoredBaseline> all;
  for (const std::filesystem::path& file : options.files) {
    all.push_back({file.string(), read_earlier_baseline(file)});
  }
  std::size_t changed = 0;
  for (std::size_t i = 1; i < all.size(); ++i) changed += print_step(all[i - 1], all[i]) ? 1 : 0;
  const std::size_t steps = all.size() - 1;
  fmt::print("{} baselines: {}\n",
             all.size(),
             changed == 0 ? "nothing changed"
                          : fmt::format("{} of {} steps with changes", changed, steps));
  if (!options.chart.empty()) draw_history(all, options.chart, options.where);
}

}  // namespace loopbench::harness
