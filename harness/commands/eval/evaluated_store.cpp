#include "harness/commands/eval/evaluated_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "datasets/core/error.hpp"
#include "harness/sweep/model/note_text.hpp"
#include "harness/sweep/store/open.hpp"
#include "harness/sweep/store/read.hpp"
#include "harness/sweep/text/counted.hpp"

namespace loopbench::harness {
namespace {

auto run_labels(const EvaluatedRun& run) { return std::tie(run.sequence, run.method, run.run); }

/// The runs of a store. Throws InputError if it has none.
std::vector<EvaluatedRun> stored_runs(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file) || has_no_tables(file)) return {};
  std::vector<EvaluatedRun> out = runs_of_manifest(read_run(file)["config"]);
  if (out.empty()) {
    throw InputError(file.string() + ": is the store of a sweep, expected one of eval --store");
  }
  return out;
}

/// One reference for each sequence: results against different references cannot be averaged.
void check_references(const std::vector<EvaluatedRun>& runs) {
  std::map<std::string, std::string> known;
  for (const EvaluatedRun& run : runs) {
    const auto [found, is_new] = known.emplace(run.sequence, run.reference);
    if (is_new || found->second == run.reference) continue;
    throw InputError("sequence '" + run.sequence + "' has two references, " + found->second +
                     " and " + run.reference + "; name one of them with --sequence NAME");
  }
}

/// Empty if all scores could be computed or are undefined.
std::string why_failed(const CellResult& result) {
  if (is_failure(result.status)) return result.why;
  const auto failed = std::ranges::find_if(result.scores, is_failure, &ScoreResult::status);
  if (failed == result.scores.end()) return "";
  const bool is_all = std::ranges::all_of(result.scores, is_failure, &ScoreResult::status);
  return is_all ? failed->why : failed->label + ": " + failed->why;
}

}  // namespace

std::vector<EvaluatedRun> with_stored(const std::filesystem::path& file,
                                      const std::vector<EvaluatedRun>& added,
                                      std::vector<std::string>& notes) {
  std::vector<EvaluatedRun> out = stored_runs(file);
  for (const EvaluatedRun& run : added) {
    const auto same = std::ranges::find_if(
        out, [&](const EvaluatedRun& other) { return run_labels(other) == run_labels(run); });
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
  check_references(out);
  return out;
}

std::string evaluated_again(const std::vector<Cell>& missing,
                            const std::vector<EvaluatedRun>& runs,
                            const std::vector<EvaluatedRun>& added) {
  const auto count = std::ranges::count_if(missing, [&](const Cell& cell) {
    return std::ranges::none_of(added, [&](const EvaluatedRun& run) {
      return run_labels(run) == run_labels(runs[cell.dataset]);
    });
  });
  if (count == 0) return "";
  return std::to_string(count) + (count == 1 ? " earlier run is" : " earlier runs are") +
         " evaluated again, because options, files or the program have changed";
}

void StoreSummary::add(const FileEvaluation& evaluation, const std::string& estimate) {
  const CellResult& result = evaluation.result;
  incomplete_ += result.status == Status::incomplete ? 1 : 0;
  const std::string why = why_failed(result);
  const bool names_files =
      std::ranges::any_of(evaluation.protocols, &EvaluationResult::names_files);
  if (!why.empty()) failures_.push_back(names_files ? why : estimate + ": " + why);
  if (!result.metadata) return;
  std::set<std::pair<NoteKind, std::string>> own;  // a file can have several notes of one kind
  for (const Note& note : result.metadata->notes) {
    const bool is_text = note.numbers.empty() && !is_of_doctor(note.kind);
    const std::pair<NoteKind, std::string> key(note.kind, is_text ? note.detail : "");
    if (own.insert(key).second) notes_.add(key, estimate + ": " + harness::text(note));
  }
}

std::vector<std::string> StoreSummary::notes() const {
  std::vector<std::string> doctor, others;
  for (const auto& [key, list] : notes_.lists) {
    std::string& line = (is_of_doctor(key.first) ? doctor : others).emplace_back(list.front());
    if (list.size() > 1) line += " (and " + counted(list.size() - 1, "more run") + ")";
  }
  doctor.insert(doctor.end(), others.begin(), others.end());
  return doctor;
}

std::string StoreSummary::text(const std::filesystem::path& file,
                               const EvaluatedSweep& files,
                               std::size_t stored) const {
  constexpr std::size_t kMost = 5;
  std::string out = fmt::format("{} in {}", counted(files.cells.size(), "run"), file.string());
  if (stored > 0) out += fmt::format(" ({} stored before)", stored);
  if (!failures_.empty()) out += fmt::format(", {} failed", failures_.size());
  if (incomplete_ > 0) {
    out += fmt::format(", {} with coverage below {:g}", incomplete_, files.sweep.min_coverage);
  }
  out += "\n";
  for (std::size_t i = 0; i < std::min(failures_.size(), kMost); ++i) {
    out += "failed: " + failures_[i] + "\n";
  }
  if (failures_.size() > kMost) {
    out += fmt::format("failed: {} more, listed by `loopbench report {}`\n",
                       failures_.size() - kMost,
                       files.arguments.store);
  }
  return out;
}

}  // namespace loopbench::harness
