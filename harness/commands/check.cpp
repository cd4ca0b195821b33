#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "datasets/core/error.hpp"
#include "harness/answers/gate/gate.hpp"
#include "harness/answers/notes/counted_notes.hpp"
#include "harness/answers/tables/gate_comment.hpp"
#include "harness/answers/tables/gate_table.hpp"
#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/text/counted.hpp"
#include "harness/sweep/text/print_error.hpp"
#include "harness/sweep/text/printable.hpp"

namespace loopbench::harness {
namespace {

struct CheckArguments {
  std::string store;
  std::string baseline;
  std::string junit;
  std::string markdown;
  bool update = false;
  bool part = false;
  bool allow_dirty = false;
  std::optional<double> time;  ///< relative limit on times, written by --update
};

/// To standard error if standard output is the output file.
void print_summary(bool stdout_in_use, const std::string& text) {
  if (stdout_in_use) {
    print_error("{}", text);
  } else {
    fmt::print("{}", text);
  }
}

/// "room / dual: timeout: 600 s"
std::vector<std::string> failed_cells(const Snapshot& snapshot) {
  std::vector<std::string> out;
  for (const auto& cell : by_cell(snapshot.records)) {
    const Record& first = cell.front();
    if (first.has_score() || !is_failure(first.status)) continue;
    out.push_back(first.cell->name() + ": " + to_text(first.status) + ": " + first.why);
  }
  return out;
}

std::string failures_text(const std::vector<std::string>& failed) {
  constexpr std::size_t kMost = 5;
  if (failed.empty()) return "";
  std::string out =
      fmt::format("{} failed, and the baseline expects that:\n", counted(failed.size(), "cell"));
  for (std::size_t i = 0; i < std::min(kMost, failed.size()); ++i) {
    out += "  " + printable(failed[i]) + "\n";
  }
  return failed.size() <= kMost ? out : out + fmt::format("  and {} more\n", failed.size() - kMost);
}

/// --update keeps the limits, which are set by hand.
int update(const CheckArguments& arguments) {
  Baseline baseline;
  if (std::filesystem::exists(arguments.baseline)) {
    baseline.limits = read_limits(arguments.baseline);
  }
  if (arguments.time) {
    std::erase_if(baseline.limits, [](const Tolerance& limit) { return limits_time(limit); });
    const std::vector<Tolerance> times = time_limits(*arguments.time);
    baseline.limits.insert(baseline.limits.begin(), times.begin(), times.end());
  }
  baseline.snapshot = snapshot(arguments.store, baseline.limits);
  if (arguments.time) {  // a sweep without replays has no times of updates
    std::erase_if(baseline.limits, [&](const Tolerance& limit) {
      return limits_time(limit) && !selects_a_score(limit, baseline.snapshot);
    });
  }
  try {
    require_used_limits(baseline);
  } catch (const InputError& error) {
    throw InputError(arguments.baseline + ": " + error.what());
  }
  baseline.build_summary = build_summary(arguments.store);
  if (is_dirty(baseline.build_summary) && !arguments.allow_dirty) {
    throw InputError(arguments.store +
                     ": was computed by a build with uncommitted changes, which cannot be "
                     "reproduced; commit, build and run again, or accept it with --allow-dirty");
  }
  const std::vector<std::string> failed = failed_cells(baseline.snapshot);
  const std::size_t cells = by_cell(baseline.snapshot.records).size();
  if (failed.size() == cells) {
    throw InputError(arguments.store +
                     ": every cell failed, a baseline needs results: " + failed.front());
  }
  write_file(arguments.baseline, json(baseline));
  print_summary(is_dash(arguments.baseline),
                fmt::format("{}: {} written\n{}",
                            printable(arguments.baseline),
                            counted(cells, "cell"),
                            failures_text(failed)));
  return kExitOk;
}

int check_store(const CheckArguments& arguments) {
  if (arguments.update) return update(arguments);
  if (arguments.time) throw InputError("--time: needs --update, which writes the limit");
  const Baseline baseline = read_baseline(arguments.baseline);
  if (is_dirty(baseline.build_summary) && !arguments.allow_dirty) {
    throw InputError(
        arguments.baseline +
        ": build_summary.source: was written by a build with uncommitted changes (dirty), "
        "expected a clean build; write it again with --update, or accept it with "
        "--allow-dirty");
  }
  const Snapshot now = snapshot(arguments.store, baseline.limits);
  GateReport report;
  try {
    report = check(baseline, now, arguments.part ? GateExtent::part : GateExtent::complete);
  } catch (const InputError& error) {
    throw InputError(arguments.baseline + ": " + error.what());
  }
  report.above = texts(counted_notes(arguments.store), Severity::decisive);
  const std::string text = markdown(report, baseline.snapshot.sweep);
  if (!arguments.markdown.empty()) {
    write_file(arguments.markdown, comment(report, baseline.snapshot.sweep));
  }
  if (!arguments.junit.empty()) write_file(arguments.junit, junit(report, baseline.snapshot.sweep));
  const bool is_taken = is_dash(arguments.junit) || is_dash(arguments.markdown);
  print_summary(is_taken, text);
  return report.passes() ? kExitOk : kExitRegression;
}

}  // namespace

void add_check(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<CheckArguments>();
  CheckArguments& a = *arguments;
  CLI::App& command = *app.add_subcommand("check", "Compare a sweep with its baseline");
  declare_store(command, a.store);
  CLI::Option* const baseline = add(command,
                                    "--baseline FILE",
                                    a.baseline,
                                    "Baseline file, for example results/reference/quickstart.json")
                                    ->required();
  writes(
      command, add(command, "--junit FILE", a.junit, "JUnit XML file to write"), FileKind::printed);
  writes(
      command,
      add(command,
          "--markdown FILE",
          a.markdown,
          "Markdown summary to write, short enough for a comment: the findings by method and the "
          "20 worst cells"),
      FileKind::printed);
  updates(command,
          baseline,
          FileKind::baseline,
          command.add_flag(
              "--update", a.update, "Write the baseline from this store and keep its limits"));
  command.add_flag(
      "--part", a.part, "Accept missing cells, because only a part of the sweep was run");
  command.add_flag(
      "--allow-dirty", a.allow_dirty, "Accept a baseline from a build with uncommitted changes");
  add(command,
      "--time SHARE",
      a.time,
      "With --update: also check times of cells and updates, with this maximum relative increase "
      "(plus 1 ms)")
      ->check(number_between(0.0, 1e9));
  command.callback([arguments, &exit_code] { exit_code = check_store(*arguments); });
}

}  // namespace loopbench::harness
