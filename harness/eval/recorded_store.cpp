#include "harness/eval/recorded_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

#include "datasets/core/error.hpp"
#include "datasets/core/parallel.hpp"
#include "harness/base/counted.hpp"
#include "harness/eval/common_parts.hpp"
#include "harness/eval/recorded_evaluation.hpp"
#include "harness/run/build.hpp"
#include "harness/store/open.hpp"
#include "harness/store/resume.hpp"
#include "harness/store/store.hpp"

namespace loopbench::harness {
namespace {

constexpr const char* kStoreFile = "results.sqlite";

auto run_labels(const RecordedRun& run) { return std::tie(run.sequence, run.method, run.run); }

/// The runs of a store. Throws InputError if it has none.
std::vector<RecordedRun> stored_runs(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file) || has_no_tables(file)) return {};
  std::vector<RecordedRun> out = runs_of_manifest(read_run(file)["config"]);
  if (out.empty()) {
    throw InputError(file.string() + ": is the store of a sweep, expected one of eval --store");
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

using References = std::map<std::string, SharedReference>;  // by RecordedRun::reference

/// Reads the references of cells that are not known yet. Throws InputError.
void read_references(const std::vector<Cell>& cells,
                     const RecordedSweep& files,
                     References& known) {
  for (const Cell& cell : cells) {
    const std::string& reference = files.runs[cell.dataset].reference;
    if (!known.contains(reference)) known.emplace(reference, shared_reference(reference, files));
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

/// Notes of many files, one line for each kind (the text before the first colon, or the second one
/// after "doctor:"): that of the first file with it, and the number of further files.
class NotesByKind {
 public:
  void add(const std::string& file, const std::vector<std::string>& notes) {
    std::set<std::string> counted;  // a file can have several notes of one kind
    for (const std::string& note : notes) {
      const std::size_t begin = note.starts_with(kDoctor) ? kDoctor.size() : 0;
      const std::string kind = note.substr(0, note.find(':', begin));
      if (!counted.insert(kind).second) continue;
      const auto known = std::ranges::find(kinds_, kind, &Kind::name);
      if (known == kinds_.end()) {
        kinds_.push_back({kind, file + ": " + note});
      } else {
        ++known->more;
      }
    }
  }

  /// Findings of the doctor first, then in order of appearance.
  std::vector<std::string> lines() const {
    std::vector<std::string> out;
    for (const bool is_doctor : {true, false}) {
      for (const Kind& kind : kinds_) {
        if (kind.name.starts_with(kDoctor) != is_doctor) continue;
        out.push_back(kind.first);
        if (kind.more == 0) continue;
        out.back() += fmt::format(" (and {} more run{})", kind.more, kind.more == 1 ? "" : "s");
      }
    }
    return out;
  }

 private:
  static constexpr std::string_view kDoctor = "doctor: ";
  struct Kind {
    std::string name;
    std::string first;  ///< file and note
    std::size_t more = 0;
  };
  std::vector<Kind> kinds_;
};

/// Counts for the summary.
struct Outcome {
  std::size_t failed = 0;  ///< including runs of which a metric failed
  std::size_t incomplete = 0;
  std::vector<std::string> failures;  ///< "FILE: reason"

  void add(const CellResult& result, const std::string& estimate) {
    incomplete += result.status == Status::incomplete ? 1 : 0;
    const std::string why = why_failed(result);
    if (why.empty()) return;
    ++failed;
    const bool names_file = why.find(estimate) != std::string::npos;
    failures.push_back(names_file ? why : estimate + ": " + why);
  }
};

/// With the reasons of at most five failures.
std::string summary(std::size_t cells,
                    std::size_t stored,
                    const Outcome& o,
                    const RecordedSweep& files) {
  constexpr std::size_t kMost = 5;
  const std::string& store = files.arguments.store;
  std::string out = fmt::format(
      "{} in {}", counted(cells, "run"), (std::filesystem::path(store) / kStoreFile).string());
  if (stored > 0) out += fmt::format(" ({} stored before)", stored);
  if (o.failed > 0) out += fmt::format(", {} failed", o.failed);
  if (o.incomplete > 0) {
    out += fmt::format(", {} with coverage below {:g}", o.incomplete, files.sweep.min_coverage);
  }
  out += "\n";
  for (std::size_t i = 0; i < std::min(o.failures.size(), kMost); ++i) {
    out += "failed: " + o.failures[i] + "\n";
  }
  if (o.failures.size() > kMost) {
    out += fmt::format(
        "failed: {} more, listed by `loopbench report {}`\n", o.failures.size() - kMost, store);
  }
  return out;
}

}  // namespace

StoredRuns store_runs(const std::vector<RecordedRun>& added,
                      const EvalArguments& a,
                      const Source& source) {
  const std::filesystem::path file = std::filesystem::path(a.store) / kStoreFile;
  const std::vector<RecordedRun> stored = stored_runs(file);
  StoredRuns out;
  std::vector<RecordedRun> runs = with_stored(stored, added, out.notes);
  check_references(runs);
  if (a.common.value_or(true)) set_common_times(runs, a);
  const RecordedSweep files = recorded_sweep(std::move(runs), a);
  CellKeys keys(files.sweep, files.catalogue, DataRoot{}, build_id(source.code));
  // Before the store changes: stored results are kept if a reference cannot be read.
  References references;
  const std::vector<Cell> missing =
      stored.empty() ? files.cells : missing_cells(file, keys, files.cells, files.cells);
  read_references(missing, files, references);
  const std::string again = evaluated_again(missing, files.runs, added);
  if (!again.empty()) out.notes.push_back(again);
  std::filesystem::create_directories(a.store);
  Store store(file, keys, provenance(source, files.sweep, files.catalogue));
  // A failure can be repaired without a change of the estimate, for example by its permissions.
  const Resumed resumed = store.resume(files.cells, files.cells, Retry::failed);
  read_references(resumed.missing, files, references);
  std::map<std::string, std::vector<Cell>> by_reference;
  for (const Cell& cell : resumed.missing) {
    by_reference[files.runs[cell.dataset].reference].push_back(cell);
  }
  Outcome outcome{resumed.failed, resumed.incomplete, {}};
  NotesByKind notes;
  for (const auto& [name, cells] : by_reference) {
    std::vector<CellResult> results(cells.size());
    parallel_for_tasks(cells.size(),
                       [&, &own = cells, &reference = references.at(name)](std::size_t i) {
                         results[i] = evaluate_recorded(own[i], files, reference).result;
                       });
    for (const CellResult& result : results) {
      const std::string& estimate = files.runs[result.cell.dataset].estimate;
      store.write(result);
      outcome.add(result, estimate);
      if (result.metadata) notes.add(estimate, result.metadata->notes);
    }
  }
  store.close();
  std::ranges::move(notes.lines(), std::back_inserter(out.notes));
  out.summary = summary(files.cells.size(), resumed.there, outcome, files);
  out.are_ok = outcome.failed + outcome.incomplete == 0;
  return out;
}

}  // namespace loopbench::harness
