#include <fmt/format.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "harness/answers/tables/record_csv.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/eval/end_error.hpp"
#include "harness/commands/eval/eval_figures.hpp"
#include "harness/commands/eval/eval_options.hpp"
#include "harness/commands/eval/evaluate_files.hpp"
#include "harness/commands/eval/evaluated_parts.hpp"
#include "harness/commands/eval/run_summary.hpp"
#include "harness/commands/standard_output.hpp"
#include "harness/sweep/model/note_text.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/text/printable.hpp"
#include "harness/sweep/text/wrap.hpp"

namespace loopbench::harness {
namespace {

/// Set if standard output is a terminal: its width, without colours, because names of files are
/// escaped after the layout.
std::optional<TerminalStyle> terminal_style(const EvalArguments& a) {
  if (!is_dash(a.out) || !prints_to_terminal()) return std::nullopt;
  return TerminalStyle{standard_output_style().width, false};
}

/// Statistics over runs and the verdict, or why there is none.
std::string verdict_of(const EvalArguments& a,
                       const std::vector<Record>& records,
                       const std::optional<TerminalStyle>& style) {
  try {
    evaluated_runs(a.reference, a.estimates, a.sequence);
  } catch (const InputError& error) {
    std::string out;
    const std::string why = "no verdict: " + std::string(error.what());
    for (const std::string& line : wrapped(why, style ? style->width : 0)) out += line + "\n";
    return out + "\n";
  }
  return run_report(records, style);
}

/// States which ATEs differ by less than the reference's own error, if that is given.
std::string below_reference_error(const EvalArguments& a, std::vector<Record> records) {
  std::erase_if(records, [](const Record& r) {
    const bool is_ate = r.kind->metric == "ate" && r.kind->relation == "translation";
    return !is_ate || !has_numbers(r.status);
  });
  if (a.reference_sigma == 0.0 || records.empty()) return "";
  change_unit(records, "m");
  std::size_t pairs = 0, below = 0;
  std::map<std::string, std::vector<double>> ates;  // by protocol
  for (const Record& r : records) {
    const double own = r.statistics.rmse;
    for (const double other : ates[r.kind->protocol]) {
      ++pairs;
      if (std::abs(own - other) < a.reference_sigma) ++below;
    }
    ates[r.kind->protocol].push_back(own);
  }
  return fmt::format(
      "ATE differences: {} of {} are below the reference's own {:g} m (--ref-sigma)\n",
      below,
      pairs,
      a.reference_sigma);
}

Detail detail_of(const EvalArguments& a) {
  const bool is_chosen =
      !a.metrics.empty() || !a.relation.empty() || a.delta || !a.delta_unit.empty();
  if (a.full) return Detail::all;
  return is_chosen ? Detail::scores : Detail::summary;
}

std::string result_text(const EvalArguments& a, const Evaluations& evaluations) {
  const std::vector<EvaluationResult>& all = evaluations.results;
  const std::optional<TerminalStyle> style = terminal_style(a);
  const Detail detail = detail_of(a);
  if (all.size() == 1) return text(all.front(), style, detail);
  const std::vector<Table> tables = comparison(all, detail);
  // The answer is first.
  std::string out = a.parts.empty() ? verdict_of(a, evaluations.records, style) : "";
  if (!style) out += markdown(tables);
  for (std::size_t i = 0; style && i < tables.size(); ++i) {
    out += (i == 0 ? "" : "\n") + terminal(tables[i], *style);
  }
  return out + below_reference_error(a, evaluations.records);
}

/// Figures of the estimates under the first protocol.
void write_figures(const EvalArguments& a, const Evaluations& all) {
  if (a.plot.empty()) return;
  FigureData data = drawn_runs(all.results, all.runs);
  if (data.curves.empty()) throw InputError("--plot: no estimate could be evaluated");
  if (!data.note.empty()) {
    fmt::print(stderr, "{}\n", printable("loopbench: note: figures: " + data.note));
  }
  data.figures = {evaluation_page(a.plot)};
  draw({data});
  fmt::print(stderr, "{}", printable(file_list(data.figures.front())));
}

void check_outputs(const EvalArguments& a) {
  reject_standard_output("--report", a.report);
  if (a.store.empty()) return;
  reject_standard_output("--store", a.store);
  if (a.plot.empty()) return;
  throw InputError(a.store + ": for figures of a store use `loopbench plot " + a.store +
                   " -o FOLDER` afterwards, without --plot");
}

int print_stored(const EvalArguments& a, const Evaluations& stored) {
  for (const std::string& note : stored.notes) {
    fmt::print(stderr, "{}\n", printable("loopbench: note: " + note));
  }
  write_file(a.out, printable(run_report(stored.records, terminal_style(a)) + stored.summary));
  return stored.are_ok ? kExitOk : kExitSomeCellsFailed;
}

/// Gives large lists mappings of their own, which the system takes back at once: the heap would
/// keep a fifth of the memory of long trajectories.
void return_large_lists() {
#ifdef M_MMAP_THRESHOLD
  constexpr int kLarge = 4 << 20;  // [bytes]
  mallopt(M_MMAP_THRESHOLD, kLarge);
#endif
}

/// What can change a conclusion, on standard error: a CSV file has no place for it.
void print_notes(const std::vector<EvaluationResult>& results) {
  std::set<std::string> lines;
  for (const EvaluationResult& result : results) {
    for (const Note& note : result.notes) {
      const std::string line = "loopbench: note: " + result.estimate + ": " + text(note);
      const bool is_new = note.severity == Severity::decisive && lines.insert(line).second;
      if (is_new) fmt::print(stderr, "{}\n", printable(line));
    }
  }
}

std::string printed(const EvalArguments& a, const Evaluations& all) {
  if (a.json) return json(all.results);
  return a.csv ? csv(all.records) : printable(result_text(a, all));
}

/// Throws InputError if an option is given that has no effect on errors at the end.
void check_end_error(const CLI::App& command) {
  constexpr std::array kUsed{"reference",
                             "estimates",
                             "--end-error",
                             "--json",
                             "--out",
                             "--format",
                             "--times",
                             "--period",
                             "--stamp-unit",
                             "--repeats",
                             "--sort",
                             "--drop-invalid",
                             "--no-checks"};
  for (const CLI::Option* const option : command.get_options()) {
    const auto is_named = [&](const char* name) { return option->check_name(name); };
    if (option->count() == 0 || std::ranges::any_of(kUsed, is_named)) continue;
    throw InputError(fmt::format("--end-error: expected no {}, which would have no effect",
                                 option->get_lnames().empty()
                                     ? "-" + option->get_snames().front()
                                     : "--" + option->get_lnames().front()));
  }
}

int print_end_errors(const EvalArguments& a) {
  std::vector<std::string> files{a.reference};
  files.insert(files.end(), a.estimates.begin(), a.estimates.end());
  write_file(a.out, printable(end_errors(files, a, a.json)));
  return kExitOk;
}

int eval(const EvalArguments& a, const Source& source) {
  return_large_lists();
  check_outputs(a);
  if (a.end_error) return print_end_errors(a);
  if (a.estimates.empty()) throw InputError("eval: found REF alone, expected REF EST");
  const Evaluations all = a.parts.empty() ? evaluate_files(a, source) : evaluate_parts(a);
  if (!a.store.empty()) return print_stored(a, all);
  if (!a.per_pose.empty()) write_file(a.per_pose, pose_csv(all.results));
  write_figures(a, all);
  if (a.csv) print_notes(all.results);
  const std::string text = printed(a, all);
  if (is_dash(a.per_pose) && is_dash(a.out)) {
    fmt::print(stderr, "{}", text);  // rows are on standard output
  } else {
    write_file(a.out, text);
  }
  const auto is_ok = [](const EvaluationResult& each) { return status_of(each).first == "ok"; };
  return std::ranges::all_of(all.results, is_ok) ? kExitOk : kExitSomeCellsFailed;
}

}  // namespace

void add_eval(CLI::App& app, int& exit_code, const Source& source) {
  auto a = std::make_shared<EvalArguments>();
  CLI::App* command = app.add_subcommand("eval", "Evaluate trajectory files against a reference");
  declare(*command, *a);
  command->callback([a, source, command, &exit_code] {
    if (a->end_error) check_end_error(*command);
    exit_code = eval(*a, source);
  });
}

}  // namespace loopbench::harness
