#include "harness/eval/recorded_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "datasets/bags/bag_name.hpp"
#include "datasets/core/parallel.hpp"
#include "harness/eval/recorded_sweep.hpp"
#include "harness/execution/run/evaluation_notes.hpp"
#include "harness/execution/run/run_cell.hpp"
#include "harness/provenance/build.hpp"
#include "harness/provenance/summarise_sequence.hpp"
#include "harness/store/store.hpp"
#include "harness/text/hash.hpp"

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

/// Evaluates the cells of one reference; a file that cannot be read is a failed cell.
std::vector<CellResult> evaluated(const std::vector<Cell>& cells,
                                  const Sweep& sweep,
                                  const Catalogue& known) {
  const Params& first = sweep.datasets[cells.front().dataset].dataset.options;
  const Trajectory reference = recorded_reference(first);
  const InputFile reference_file =
      hashed_inputs({{file_of(to_text(first.at("reference"))), ""}}).front();
  std::vector<CellResult> out(cells.size());
  const std::size_t threads = std::min(hardware_threads(), cells.size());
  parallel_invoke(threads, [&](std::size_t thread) {
    for (std::size_t i = thread; i < cells.size(); i += threads) {
      const Cell& cell = cells[i];
      const DatasetChoice& choice = sweep.datasets[cell.dataset];
      out[i].cell = cell;
      try {
        const Sequence sequence = recorded_sequence(choice.dataset.options, reference);
        out[i] = run_cell(cell, sweep, sequence, known);
        SequenceMetadata metadata;
        metadata.inputs = hashed_inputs({sequence.provenance.inputs.back()});
        metadata.inputs.insert(metadata.inputs.begin(), reference_file);
        metadata.size.keyframes = static_cast<std::int64_t>(sequence.problem.keyframes.size());
        metadata.size.reference = static_cast<std::int64_t>(reference.size());
        metadata.content = Fields().add(reference_file.hash).add(choice.group).hashed();
        metadata.source = "reference:" + reference_file.hash;
        metadata.group = "group:" + choice.group;
        metadata.notes = evaluation_notes(sequence, sweep);
        metadata.trace = sequence_trace(sequence);
        out[i].metadata = std::make_shared<const SequenceMetadata>(std::move(metadata));
      } catch (const InputError& error) {
        out[i].status = Status::failed;
        out[i].why = error.what();
      }
    }
  });
  return out;
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
  const Resumed resumed = store.resume(cells, cells, Retry::none);
  RecordedSweep out{cells.size(), resumed.there, resumed.failed, resumed.incomplete, {}};
  std::map<std::string, std::vector<Cell>> by_reference;
  for (const Cell& cell : resumed.missing)
    by_reference[runs[cell.dataset].reference].push_back(cell);
  std::map<std::string, std::size_t> notes;
  for (const auto& [reference, missing] : by_reference) {
    for (const CellResult& result : evaluated(missing, sweep, known)) {
      store.write(result);
      out.failed += is_failure(result.status) ? 1 : 0;
      out.incomplete += result.status == Status::incomplete ? 1 : 0;
      if (!result.metadata) continue;
      for (const std::string& note : result.metadata->notes) ++notes[note];
    }
  }
  for (const auto& [note, count] : notes) {
    out.notes.push_back(count == 1 ? note : fmt::format("{} ({} runs)", note, count));
  }
  return out;
}

}  // namespace loopbench::harness
