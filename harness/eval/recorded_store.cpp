#include "harness/eval/recorded_store.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "datasets/core/error.hpp"
#include "harness/eval/note_summary.hpp"
#include "harness/eval/recorded_evaluation.hpp"
#include "harness/provenance/build.hpp"
#include "harness/store/store.hpp"

namespace loopbench::harness {
namespace {

auto run_labels(const RecordedRun& run) { return std::tie(run.sequence, run.method, run.run); }

/// The stored runs, where `added` replace runs with the same labels, and then the others of
/// `added`.
std::vector<RecordedRun> with_stored(const std::filesystem::path& file,
                                     const std::vector<RecordedRun>& added) {
  if (!std::filesystem::exists(file)) return added;
  std::vector<RecordedRun> out = runs_of_manifest(read_run(file)["config"]);
  if (out.empty()) {
    throw InputError(file.string() + ": is the store of a sweep, expected one of eval --store");
  }
  for (const RecordedRun& run : added) {
    const auto same = std::ranges::find_if(
        out, [&](const RecordedRun& other) { return run_labels(other) == run_labels(run); });
    if (same == out.end()) {
      out.push_back(run);
    } else {
      *same = run;
    }
  }
  return out;
}

/// One reference for each sequence: results against different references cannot be averaged.
void check_references(const std::vector<RecordedRun>& runs) {
  std::map<std::string, std::string> known;
  for (const RecordedRun& run : runs) {
    const auto [found, is_new] = known.emplace(run.sequence, run.reference);
    if (is_new || std::filesystem::path(found->second).lexically_normal() ==
                      std::filesystem::path(run.reference).lexically_normal()) {
      continue;
    }
    throw InputError("sequence '" + run.sequence + "' has two references, " + found->second +
                     " and " + run.reference + "; name one of them with --sequence NAME");
  }
}

}  // namespace

RecordedSweep store_runs(const std::vector<RecordedRun>& added,
                         const EvalArguments& a,
                         const std::filesystem::path& folder,
                         const Source& source) {
  const std::filesystem::path file = folder / "results.sqlite";
  const std::vector<RecordedRun> runs = with_stored(file, added);
  check_references(runs);
  const Catalogue known = recorded_catalogue();
  const Sweep sweep = recorded_sweep(runs, a);
  const std::vector<Cell> cells = recorded_cells(runs, sweep);
  CellKeys keys(sweep, known, DataRoot{}, build_id(source.code));
  std::filesystem::create_directories(folder);
  Store store(file, keys, provenance(source, sweep, known));
  // A failure can be repaired without a change of the estimate, for example by its permissions.
  const Resumed resumed = store.resume(cells, cells, Retry::failed);
  RecordedSweep out{cells.size(), resumed.there, resumed.failed, resumed.incomplete, {}, {}};
  std::map<std::string, std::vector<Cell>> by_reference;
  for (const Cell& cell : resumed.missing)
    by_reference[runs[cell.dataset].reference].push_back(cell);
  NoteSummary notes;
  for (const auto& [reference, missing] : by_reference) {
    for (const CellResult& result : evaluate_recorded(missing, sweep, known, a)) {
      const std::string& estimate = runs[result.cell.dataset].estimate;
      store.write(result);
      if (is_failure(result.status)) {
        ++out.failed;
        const bool names_file = result.why.find(estimate) != std::string::npos;
        out.failures.push_back(names_file ? result.why : estimate + ": " + result.why);
      }
      out.incomplete += result.status == Status::incomplete ? 1 : 0;
      if (result.metadata) notes.add(estimate, result.metadata->notes);
    }
  }
  out.notes = notes.lines();
  return out;
}

}  // namespace loopbench::harness
