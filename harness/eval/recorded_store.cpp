#include "harness/eval/recorded_store.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/core/error.hpp"
#include "datasets/core/parallel.hpp"
#include "harness/eval/note_summary.hpp"
#include "harness/eval/recorded_evaluation.hpp"
#include "harness/eval/recordings.hpp"
#include "harness/run/build.hpp"
#include "harness/store/open.hpp"
#include "harness/store/resume.hpp"
#include "harness/store/store.hpp"

namespace loopbench::harness {
namespace {

auto run_labels(const RecordedRun& run) { return std::tie(run.sequence, run.method, run.run); }

/// The runs of a store. Throws InputError if it has none, or has paths of an unknown folder.
std::vector<RecordedRun> stored_runs(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file) || has_no_tables(file)) return {};
  std::vector<RecordedRun> out = runs_of_manifest(read_run(file)["config"]);
  if (out.empty()) {
    throw InputError(file.string() + ": is the store of a sweep, expected one of eval --store");
  }
  for (const RecordedRun& run : out) {
    for (const std::string& name : {run.reference, run.estimate}) {
      if (file_of(name) == "-" || std::filesystem::path(file_of(name)).is_absolute()) continue;
      throw InputError(file.string() + ": has the relative path " + name +
                       " of an earlier version, whose folder is unknown; evaluate its files into "
                       "a new store");
    }
  }
  return out;
}

/// The stored runs, where `added` replace runs with the same labels, and then the others of
/// `added`. `notes`: receives runs that are replaced by another file.
std::vector<RecordedRun> with_stored(const std::vector<RecordedRun>& stored,
                                     const std::vector<RecordedRun>& added,
                                     std::vector<std::string>& notes) {
  std::vector<RecordedRun> out = stored;
  for (const RecordedRun& run : added) {
    const auto same = std::ranges::find_if(
        out, [&](const RecordedRun& other) { return run_labels(other) == run_labels(run); });
    if (same == out.end()) {
      out.push_back(run);
      continue;
    }
    if (same->estimate != run.estimate) {
      notes.push_back(run.estimate + ": replaces " + same->estimate + " as run " + run.run +
                      " of '" + run.method + "' on '" + run.sequence + "'");
    }
    *same = run;
  }
  return out;
}

/// One reference for each sequence: results against different references cannot be averaged.
void check_references(const std::vector<RecordedRun>& runs) {
  std::map<std::string, std::string> known;
  for (const RecordedRun& run : runs) {
    const auto [found, is_new] = known.emplace(run.sequence, run.reference);
    if (is_new || found->second == run.reference) continue;
    throw InputError("sequence '" + run.sequence + "' has two references, " + found->second +
                     " and " + run.reference + "; name one of them with --sequence NAME");
  }
}

/// Finds copies of a recording among the references of all runs.
void find_recordings(const std::vector<RecordedRun>& runs,
                     const Sweep& sweep,
                     const EvalArguments& a,
                     std::map<std::string, SharedReference>& known) {
  Recordings recordings;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto found = known.find(runs[i].reference);
    if (found != known.end() && !found->second.recording.empty()) continue;
    try {
      SharedReference& own =
          found != known.end()
              ? found->second
              : known
                    .emplace(runs[i].reference,
                             shared_reference(sweep.datasets[i].dataset.options, sweep, a))
                    .first->second;
      own.recording = recordings.name_of(own.content, own.read.poses);
    } catch (const InputError&) {
      continue;  // of a stored run, whose results stay
    }
  }
}

using References = std::map<std::string, SharedReference>;  // by RecordedRun::reference

/// Reads the references of cells that are not known yet. Throws InputError.
void read_references(const std::vector<Cell>& cells,
                     const std::vector<RecordedRun>& runs,
                     const Sweep& sweep,
                     const EvalArguments& a,
                     References& known) {
  for (const Cell& cell : cells) {
    const std::string& reference = runs[cell.dataset].reference;
    if (known.contains(reference)) continue;
    known.emplace(reference,
                  shared_reference(sweep.datasets[cell.dataset].dataset.options, sweep, a));
  }
}

/// A note on stored runs that are evaluated although they were not given; empty if there is none.
std::string evaluated_again(const std::vector<Cell>& missing,
                            const std::vector<RecordedRun>& runs,
                            const std::vector<RecordedRun>& added) {
  const auto count = std::ranges::count_if(missing, [&](const Cell& cell) {
    return std::ranges::none_of(added, [&](const RecordedRun& run) {
      return run_labels(run) == run_labels(runs[cell.dataset]);
    });
  });
  if (count == 0) return "";
  return std::to_string(count) + (count == 1 ? " earlier run is" : " earlier runs are") +
         " evaluated again, because options, files or the program have changed";
}

/// Empty if all scores could be computed or are undefined.
std::string why_failed(const CellResult& result) {
  if (is_failure(result.status)) return result.why;
  const auto failed = std::ranges::find_if(result.scores, is_failure, &ScoreResult::status);
  if (failed == result.scores.end()) return "";
  const bool is_all = std::ranges::all_of(result.scores, is_failure, &ScoreResult::status);
  return is_all ? failed->why : failed->label + ": " + failed->why;
}

void add_result(const CellResult& result,
                const std::string& estimate,
                RecordedSweep& out,
                NoteSummary& notes) {
  if (const std::string why = why_failed(result); !why.empty()) {
    ++out.failed;
    const bool names_file = why.find(estimate) != std::string::npos;
    out.failures.push_back(names_file ? why : estimate + ": " + why);
  }
  out.incomplete += result.status == Status::incomplete ? 1 : 0;
  if (result.metadata) notes.add(estimate, result.metadata->notes);
}

}  // namespace

RecordedSweep store_runs(const std::vector<RecordedRun>& added,
                         const EvalArguments& a,
                         const std::filesystem::path& folder,
                         const Source& source) {
  const std::filesystem::path file = folder / "results.sqlite";
  const std::vector<RecordedRun> stored = stored_runs(file);
  RecordedSweep out;
  std::vector<RecordedRun> runs = with_stored(stored, added, out.notes);
  check_references(runs);
  const Catalogue known = recorded_catalogue(a.plugins);
  if (a.common.value_or(true)) set_common_times(runs, a);
  const Sweep sweep = recorded_sweep(runs, a, known);
  const std::vector<Cell> cells = recorded_cells(runs, sweep);
  CellKeys keys(sweep, known, DataRoot{}, build_id(source.code));
  // Before the store changes: stored results are kept if a reference cannot be read.
  References references;
  const std::vector<Cell> missing =
      stored.empty() ? cells : missing_cells(file, keys, cells, cells);
  read_references(missing, runs, sweep, a, references);
  const std::string again = evaluated_again(missing, runs, added);
  if (!again.empty()) out.notes.push_back(again);
  std::filesystem::create_directories(folder);
  Store store(file, keys, provenance(source, sweep, known));
  // A failure can be repaired without a change of the estimate, for example by its permissions.
  const Resumed resumed = store.resume(cells, cells, Retry::failed);
  read_references(resumed.missing, runs, sweep, a, references);
  if (!resumed.missing.empty()) find_recordings(runs, sweep, a, references);
  out.cells = cells.size();
  out.stored = resumed.there;
  out.failed = resumed.failed;
  out.incomplete = resumed.incomplete;
  std::map<std::string, std::vector<Cell>> by_reference;
  for (const Cell& cell : resumed.missing)
    by_reference[runs[cell.dataset].reference].push_back(cell);
  NoteSummary notes;
  for (const auto& [name, those] : by_reference) {
    const SharedReference& reference = references.at(name);
    std::vector<CellResult> results(those.size());
    parallel_for_tasks(those.size(), [&, &cells = those](std::size_t i) {
      results[i] = evaluate_recorded(cells[i], sweep, reference, known, a).result;
    });
    for (const CellResult& result : results) {
      store.write(result);
      add_result(result, runs[result.cell.dataset].estimate, out, notes);
    }
  }
  store.close();
  std::ranges::move(notes.lines(), std::back_inserter(out.notes));
  return out;
}

}  // namespace loopbench::harness
