#include "harness/commands/eval/evaluate_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <utility>

#include "datasets/core/parallel.hpp"
#include "harness/answers/report/report.hpp"
#include "harness/commands/eval/common_parts.hpp"
#include "harness/commands/eval/evaluated_store.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/run/build.hpp"
#include "harness/sweep/store/match_cells.hpp"
#include "harness/sweep/store/read.hpp"
#include "harness/sweep/store/store.hpp"
#include "harness/sweep/text/printable.hpp"

namespace loopbench::harness {
namespace {

using References = std::map<std::string, SharedReference>;  // by EvaluatedRun::reference

std::filesystem::path store_of(const EvalArguments& a) {
  return a.store.empty() ? memory_store() : std::filesystem::path(a.store) / "results.sqlite";
}

bool is_new(const std::filesystem::path& store) {
  return !std::filesystem::exists(store) || has_no_tables(store);
}

/// With the names of files as given unless they are stored.
std::vector<EvaluatedRun> runs_of(const EvalArguments& a) {
  std::vector<EvaluatedRun> out;
  if (!a.store.empty()) {
    out = evaluated_runs(a.reference, a.estimates, a.sequence);
    for (EvaluatedRun& run : out) run.group = a.group;
    return out;
  }
  out = labelled_runs(a.reference, a.estimates, a.sequence);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].reference = a.reference;
    out[i].estimate = a.estimates[i];
  }
  return out;
}

/// Reason if the coverage is less than half of the `best` of an estimate under the same protocol,
/// or less than a tenth: too little is evaluated, or stamps meet by chance. A sparse reference
/// pairs few poses of an estimate, hence the share of either file's poses counts.
std::string why_low_coverage(const EvaluationResult& own, double best) {
  constexpr double kMuchLess = 0.5;
  constexpr double kLeast = 0.1;
  const metrics::Coverage& found = own.coverage;
  const double of_reference =
      static_cast<double>(found.pairs) / static_cast<double>(own.reference_poses);
  const bool is_little = std::min(std::max(found.share(), of_reference), found.span) < kLeast;
  const bool is_less = found.least() < kMuchLess * best;
  if (!is_less && !is_little) return "";
  return fmt::format(
      "evaluated {} of {} poses over {:.1f} % of the reference's time, less than {} "
      "(--min-coverage 0 accepts it)",
      found.pairs,
      found.possible,
      100.0 * found.span,
      is_less ? fmt::format("half of the {:.1f} % of another estimate", 100.0 * best) : "a tenth");
}

/// Marks evaluations as incomplete whose coverage is small; their scores remain. `all`: not empty.
void check_coverage(std::vector<FileEvaluation>& all) {
  for (std::size_t p = 0; p < all.front().protocols.size(); ++p) {
    double most = 0.0;
    for (const FileEvaluation& file : all)
      most = std::max(most, file.protocols[p].coverage.least());
    for (FileEvaluation& file : all) {
      EvaluationResult& own = file.protocols[p];
      if (!own.why_failed.empty()) continue;
      own.incomplete_reason = why_low_coverage(own, most);
      if (own.incomplete_reason.empty()) continue;
      for (ScoreResult& score : file.result.scores) {
        if (score.protocol != p || score.status != Status::ok) continue;
        score.status = Status::incomplete;
        score.why = own.incomplete_reason;
      }
    }
  }
}

/// Throws InputError if the only evaluation failed.
void require_evaluated(const std::vector<FileEvaluation>& all) {
  if (all.size() != 1 || all.front().protocols.size() != 1) return;
  const EvaluationResult& own = all.front().protocols.front();
  if (own.why_failed.empty()) return;
  throw InputError(own.names_files
                       ? own.why_failed
                       : own.estimate + " with reference " + own.reference + ": " + own.why_failed);
}

/// The records of a store in memory, by file, and those of each evaluation.
void add_records(Evaluations& out, const EvaluatedSweep& files, std::vector<FileEvaluation> all) {
  std::ranges::stable_sort(out.records, {}, [&](const Record& record) {
    return files.cells[static_cast<std::size_t>(record.cell->position)].dataset;
  });
  if (!files.arguments.unit.empty()) change_unit(out.records, files.arguments.unit);
  for (FileEvaluation& each : all) {
    for (EvaluationResult& own : each.protocols) {
      std::ranges::copy_if(out.records, std::back_inserter(own.records), [&](const Record& r) {
        return r.cell->position == static_cast<std::int64_t>(each.result.cell.index) &&
               own.why_failed.empty() && r.kind->protocol == own.protocol.label();
      });
      out.results.push_back(std::move(own));
    }
  }
}

void write_page(const std::filesystem::path& store, const EvalArguments& a) {
  write_file(a.report, report_html(read_report_content(store, kReportBytes), kReportBytes));
  fmt::print(stderr, "{}\n", printable(a.report));
}

/// Evaluates files with one reference; those that are not kept in a store are in the order of the
/// arguments, and compared with each other.
std::vector<FileEvaluation> evaluated_cells(const std::vector<Cell>& cells,
                                            const EvaluatedSweep& files,
                                            const SharedReference& reference,
                                            const EvaluatedFile* estimate) {
  std::vector<FileEvaluation> out(cells.size());
  parallel_for_tasks(cells.size(), [&](std::size_t i) {
    out[i] = estimate ? evaluate_poses(cells[i], files, reference, *estimate)
                      : evaluate_file(cells[i], files, reference);
  });
  const EvalArguments& a = files.arguments;
  if (!a.store.empty()) return out;
  std::ranges::sort(out, {}, [](const FileEvaluation& each) { return each.result.cell.dataset; });
  if (!a.keeps_failed) require_evaluated(out);
  if (!a.min_coverage) check_coverage(out);
  return out;
}

/// Evaluates the files that the store has not, one reference after the other, so that few results
/// are in memory; `estimate`: the only one, if it is not a file.
Evaluations evaluated(EvaluatedSweep files,
                      const std::vector<EvaluatedRun>& added,
                      References references,
                      const EvaluatedFile* estimate,
                      const Source& source,
                      Evaluations out = {}) {
  const EvalArguments& a = files.arguments;
  const bool is_kept = !a.store.empty();
  const std::filesystem::path file = store_of(a);
  const auto reference_of = [&](const Cell& cell) { return files.runs[cell.dataset].reference; };
  const auto read_reference = [&](const std::string& name) -> const SharedReference& {
    const auto known = references.find(name);
    if (known != references.end()) return known->second;
    return references.emplace(name, shared_reference(name, files)).first->second;
  };
  CellKeys keys(files.sweep, files.catalogue, DataRoot{}, build_id(source.code));
  // Before the store changes: stored results are kept if a reference cannot be read.
  const std::vector<Cell> missing =
      is_new(file) ? files.cells : missing_cells(file, keys, files.cells, files.cells);
  for (const Cell& cell : missing) read_reference(reference_of(cell));
  if (is_kept) {
    const std::string again = evaluated_again(missing, files.runs, added);
    if (!again.empty()) out.notes.push_back(again);
    std::filesystem::create_directories(a.store);
  }
  std::map<std::string, std::string> origin;
  if (a.keeps_traces()) origin = provenance(source, files.sweep, files.catalogue);
  Store store(file, keys, std::move(origin));
  // A failure can be repaired without a change of the estimate, for example by its permissions.
  const Resumed resumed = store.resume(files.cells, files.cells, Retry::failed);
  std::map<std::string, std::vector<Cell>> by_reference;
  for (const Cell& cell : resumed.missing) {
    read_reference(reference_of(cell));  // all, before results are written
    by_reference[reference_of(cell)].push_back(cell);
  }
  StoreSummary summary(resumed.incomplete);
  std::vector<FileEvaluation> all;
  for (const auto& [name, cells] : by_reference) {
    std::vector<FileEvaluation> own = evaluated_cells(cells, files, read_reference(name), estimate);
    for (const FileEvaluation& each : own) {
      store.write(each.result);
      summary.add(each, files.runs[each.result.cell.dataset].estimate);
    }
    if (!is_kept) all = std::move(own);
  }
  if (is_kept) {
    store.close();
    std::ranges::move(summary.notes(), std::back_inserter(out.notes));
    out.summary = summary.text(file, files, resumed.there);
    out.are_ok = summary.is_ok();
  }
  if (!a.report.empty()) write_page(file, a);
  out.records = read_records(file);
  if (!is_kept) add_records(out, files, std::move(all));
  out.runs = std::move(files.runs);
  return out;
}

}  // namespace

Evaluations evaluate_files(const EvalArguments& a, const Source& source) {
  check_estimates(a);
  const std::vector<EvaluatedRun> added = runs_of(a);
  Evaluations out;
  std::vector<EvaluatedRun> runs =
      a.store.empty() ? added : with_stored(store_of(a), added, out.notes);
  if (a.common.value_or(!a.store.empty())) set_common_times(runs, a);
  EvaluatedSweep files = evaluated_sweep(std::move(runs), a);
  check_stamp_options(a, files.runs);
  return evaluated(std::move(files), added, {}, nullptr, source, std::move(out));
}

Evaluations evaluate_in_memory(const EvalArguments& a,
                               EvaluatedFile reference,
                               const EvaluatedFile& estimate) {
  const std::vector<EvaluatedRun> run{{"reference", "estimate", "0", "reference", "estimate"}};
  References references;
  references.emplace("reference", SharedReference{std::move(reference)});
  return evaluated(evaluated_sweep(run, a), run, std::move(references), &estimate, {});
}

}  // namespace loopbench::harness
