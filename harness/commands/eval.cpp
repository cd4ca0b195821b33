#include <fmt/format.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>

#include "harness/base/printable.hpp"
#include "harness/base/wrap.hpp"
#include "harness/base/write_file.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/eval_options.hpp"
#include "harness/commands/standard_output.hpp"
#include "harness/eval/drawn_sequences.hpp"
#include "harness/eval/error_figures.hpp"
#include "harness/eval/eval_report.hpp"
#include "harness/eval/evaluate_files.hpp"
#include "harness/eval/recorded_store.hpp"
#include "harness/eval/recorded_sweep.hpp"
#include "harness/eval/run_summary.hpp"
#include "harness/report/store_figures.hpp"
#include "harness/store/read.hpp"
#include "harness/tables/text.hpp"

namespace loopbench::harness {
namespace {

/// Set if standard output is a terminal: its width, without colours, because names of files are
/// escaped after the layout.
std::optional<TerminalStyle> terminal_style() {
  if (!prints_to_terminal()) return std::nullopt;
  return TerminalStyle{standard_output_style().width, false};
}

/// Statistics over runs and the verdict, or why there is none.
std::string verdict_of(const EvalArguments& a,
                       const std::vector<EvaluationResult>& results,
                       const std::optional<TerminalStyle>& style = std::nullopt) {
  try {
    recorded_runs(file_pairs(a), a.sequence);
  } catch (const InputError& error) {
    std::string out = "\n";
    const std::string why = "no verdict: " + std::string(error.what());
    for (const std::string& line : wrapped(why, style ? style->width : 0)) out += line + "\n";
    return out;
  }
  return run_report(all_records(results), style, a.paired);
}

std::string result_text(const EvalArguments& a, const std::vector<EvaluationResult>& all) {
  const std::optional<TerminalStyle> style = terminal_style();
  if (all.size() == 1) return text(all.front(), style);
  const std::vector<Table> tables = comparison(all);
  std::string out;
  if (!style) out = markdown(tables);
  for (std::size_t i = 0; style && i < tables.size(); ++i) {
    out += (i == 0 ? "" : "\n") + terminal(table_view(tables[i]), *style);
  }
  return out + verdict_of(a, all, style);
}

/// `images`: kErrorFigures of each of `drawn`.
void write_report(const EvalArguments& a,
                  const std::vector<EvaluationResult>& all,
                  const std::vector<DrawnRuns>& drawn,
                  const std::vector<std::string>& images) {
  std::vector<PageImage> headed;
  for (const DrawnRuns& each : drawn) {
    const std::string sequence = each.sequence.empty() ? "" : each.sequence + ": ";
    for (const char* const name : kErrorFigures) {
      headed.push_back({sequence + name, images[headed.size()]});
    }
  }
  const bool is_alone = all.size() == 1;
  write_eval_report(a.report,
                    all.front().reference,
                    is_alone ? std::vector<Table>{} : comparison(all),
                    is_alone ? text(all.front()) : verdict_of(a, all, TerminalStyle{}),
                    headed);
  fmt::print(stderr, "{}\n", printable(a.report));
}

/// Figures and report of the estimates under the first protocol.
void write_pictures(const EvalArguments& a, const std::vector<EvaluationResult>& all) {
  if (a.plot.empty() && a.report.empty()) return;
  const std::vector<DrawnRuns> drawn =
      drawn_sequences(all, labelled_runs(file_pairs(a), a.sequence));
  if (drawn.empty()) throw InputError("--plot, --report: no estimate could be evaluated");
  for (const DrawnRuns& each : drawn) {
    if (each.note.empty()) continue;
    const std::string sequence = each.sequence.empty() ? "" : each.sequence + ": ";
    fmt::print(stderr, "{}\n", printable("loopbench: note: figures: " + sequence + each.note));
  }
  reject_standard_output("--report", a.report);
  std::set<std::string> prefixes;
  std::vector<FigureData> figures;
  for (const DrawnRuns& each : drawn) {
    FigureData& data = figures.emplace_back(figure_data(each));
    if (!a.report.empty()) data.figures = figures_for_page();
    if (a.plot.empty()) continue;
    std::string prefix = a.plot;
    if (!each.sequence.empty()) prefix += "_" + file_stem(each.sequence);
    while (!prefixes.insert(prefix).second) prefix += "_";  // labels that differ in punctuation
    std::ranges::move(figures_for_paper(prefix, a.plot_size), std::back_inserter(data.figures));
  }
  const std::vector<std::string> images = draw(figures);
  if (!a.report.empty()) write_report(a, all, drawn, images);
  for (const FigureData& data : figures) {
    for (const DrawnFigure& figure : data.figures) {
      for (const auto& file : figure.files) fmt::print(stderr, "{}\n", printable(file.string()));
    }
  }
}

/// Rejects options that have no effect on a store, before anything is evaluated.
void check_store_options(const EvalArguments& a, const std::vector<RecordedRun>& runs) {
  const std::string store = a.store + ": --store writes results only; for ";
  if (!a.report.empty()) {
    throw InputError(store + "--report use `loopbench report " + a.store + " -o " + a.report +
                     "` afterwards");
  }
  if (!a.plot.empty()) {
    throw InputError(store + "--plot use `loopbench plot " + a.store + " -o FOLDER` afterwards");
  }
  check_stamp_options(a, runs);
}

/// Summary of the failed files, at most five of them.
std::string failures_text(const RecordedSweep& stored, const std::string& store) {
  constexpr std::size_t kMost = 5;
  std::string out;
  for (std::size_t i = 0; i < std::min(stored.failures.size(), kMost); ++i) {
    out += "failed: " + stored.failures[i] + "\n";
  }
  if (stored.failures.size() > kMost) {
    out += fmt::format("failed: {} more, listed by `loopbench report {}`\n",
                       stored.failures.size() - kMost,
                       store);
  }
  return out;
}

int eval_to_store(const EvalArguments& a, const Source& source) {
  reject_standard_output("--store", a.store);
  std::vector<RecordedRun> runs = recorded_runs(file_pairs(a), a.sequence);
  for (RecordedRun& run : runs) run.group = a.group;
  check_store_options(a, runs);
  const RecordedSweep stored = store_runs(runs, a, a.store, source);
  for (const std::string& note : stored.notes) {
    fmt::print(stderr, "{}\n", printable("loopbench: note: " + note));
  }
  const std::string report = run_report(read_records(a.store), terminal_style(), a.paired);
  fmt::print("{}\n{} runs in {}{}{}{}\n{}",
             printable(report),
             stored.cells,
             printable((std::filesystem::path(a.store) / "results.sqlite").string()),
             stored.stored == 0 ? "" : fmt::format(" ({} stored before)", stored.stored),
             stored.failed == 0 ? "" : fmt::format(", {} failed", stored.failed),
             stored.incomplete == 0 ? ""
                                    : fmt::format(", {} with coverage below {:g}",
                                                  stored.incomplete,
                                                  a.min_coverage.value_or(kDefaultMinCoverage)),
             printable(failures_text(stored, a.store)));
  return stored.failed + stored.incomplete == 0 ? kExitOk : kExitSomeCellsFailed;
}

/// Gives large lists mappings of their own, which the system takes back at once: the heap would
/// keep a fifth of the memory of long trajectories.
void return_large_lists() {
#ifdef M_MMAP_THRESHOLD
  constexpr int kLarge = 4 << 20;  // [bytes]
  mallopt(M_MMAP_THRESHOLD, kLarge);
#endif
}

int eval(const EvalArguments& a, const Source& source) {
  if (a.estimates.empty() && !std::filesystem::is_directory(a.reference)) {
    throw CLI::RequiredError("EST");
  }
  return_large_lists();
  if (!a.store.empty()) return eval_to_store(a, source);
  const std::vector<EvaluationResult> all = evaluate_files(a);
  if (!a.per_pose.empty()) write_file(a.per_pose, pose_csv(all));
  write_pictures(a, all);
  if (a.json) {
    fmt::print("{}", json(all));
  } else if (a.csv) {
    fmt::print("{}", csv(all_records(all)));
  } else {
    fmt::print("{}", printable(result_text(a, all)));
  }
  const bool all_ok = std::ranges::all_of(
      all, [](const EvaluationResult& result) { return status(result) == "ok"; });
  return all_ok ? kExitOk : kExitSomeCellsFailed;
}

}  // namespace

void add_eval(CLI::App& app, int& exit_code, const Source& source) {
  auto a = std::make_shared<EvalArguments>();
  CLI::App* command = app.add_subcommand("eval", "Evaluate trajectory files against a reference");
  declare(*command, *a);
  command->callback([a, source, &exit_code] { exit_code = eval(*a, source); });
}

}  // namespace loopbench::harness
