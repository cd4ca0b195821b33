#include "harness/eval/evaluate_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <utility>

#include "datasets/core/parallel.hpp"
#include "harness/base/write_file.hpp"
#include "harness/eval/common_parts.hpp"
#include "harness/run/build.hpp"
#include "harness/store/read.hpp"
#include "harness/store/store.hpp"

namespace loopbench::harness {
namespace {

/// With the names of files as given, and those of --labels: one for each file, or else one for each
/// method.
std::vector<RecordedRun> runs_of(const EvalArguments& a) {
  std::vector<RecordedRun> out = labelled_runs(a.reference, a.estimates, a.sequence);
  std::vector<std::string> methods;
  for (const RecordedRun& run : out) {
    const bool is_known = std::ranges::count(methods, run.method) > 0;
    if (!is_known || a.figures.labels.size() == out.size()) methods.push_back(run.method);
  }
  const std::vector<std::string> labels = labels_of(a.figures, methods);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto place = std::ranges::find(methods, out[i].method) - methods.begin();
    out[i].method = labels[labels.size() == out.size() ? i : static_cast<std::size_t>(place)];
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

/// Marks evaluations as incomplete whose coverage is small; their scores remain.
void check_coverage(std::vector<EvaluatedFile>& all) {
  std::map<std::size_t, double> most;  // by protocol
  for (const EvaluatedFile& file : all) {
    for (std::size_t p = 0; p < file.protocols.size(); ++p) {
      most[p] = std::max(most[p], file.protocols[p].coverage.least());
    }
  }
  for (EvaluatedFile& file : all) {
    for (std::size_t p = 0; p < file.protocols.size(); ++p) {
      EvaluationResult& own = file.protocols[p];
      if (!own.why_failed.empty()) continue;
      own.incomplete_reason = why_low_coverage(own, most.at(p));
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
void require_evaluated(const std::vector<EvaluatedFile>& all) {
  if (all.size() != 1 || all.front().protocols.size() != 1) return;
  const EvaluationResult& own = all.front().protocols.front();
  if (own.why_failed.empty()) return;
  const bool names_file = own.why_failed.find(own.estimate) != std::string::npos ||
                          own.why_failed.find(own.reference) != std::string::npos;
  throw InputError(names_file
                       ? own.why_failed
                       : own.estimate + " with reference " + own.reference + ": " + own.why_failed);
}

/// Writes the results to a store in memory, which `visit` gets, and reads its records.
Evaluations stored(RecordedSweep files,
                   std::vector<EvaluatedFile> all,
                   const Source& source,
                   const std::function<void(const std::filesystem::path&)>& visit) {
  require_evaluated(all);
  const EvalArguments& a = files.arguments;
  if (!a.min_coverage) check_coverage(all);
  const std::filesystem::path file = memory_store();
  CellKeys keys(files.sweep, files.catalogue, DataRoot{}, build_id(source.code));
  std::map<std::string, std::string> origin;
  if (visit) origin = provenance(source, files.sweep, files.catalogue);
  Store store(file, keys, std::move(origin));
  store.resume(files.cells, files.cells, Retry::failed);
  for (const EvaluatedFile& each : all) store.write(each.result);
  if (visit) visit(file);
  Evaluations out{{}, read_records(file), std::move(files.runs)};
  std::ranges::stable_sort(out.records, {}, [&](const Record& record) {
    return files.cells[static_cast<std::size_t>(record.cell->position)]
        .dataset;  // the order of the files
  });
  if (!a.unit.empty()) change_unit(out.records, a.unit);
  for (EvaluatedFile& each : all) {
    for (EvaluationResult& own : each.protocols) {
      std::ranges::copy_if(out.records, std::back_inserter(own.records), [&](const Record& r) {
        return r.cell->position == static_cast<std::int64_t>(each.result.cell.index) &&
               own.why_failed.empty() && r.kind->protocol == own.protocol.label();
      });
      out.results.push_back(std::move(own));
    }
  }
  return out;
}

}  // namespace

Evaluations evaluate_files(const EvalArguments& a,
                           const Source& source,
                           const std::function<void(const std::filesystem::path&)>& visit) {
  check_estimates(a);
  std::vector<std::filesystem::path> inputs{a.times, a.reference};
  inputs.insert(inputs.end(), a.estimates.begin(), a.estimates.end());
  reject_overwriting(inputs, a.per_pose);
  std::vector<RecordedRun> labelled = runs_of(a);
  if (a.common.value_or(false)) set_common_times(labelled, a);
  RecordedSweep files = recorded_sweep(std::move(labelled), a);
  check_stamp_options(a, files.runs);
  std::vector<Cell> cells = files.cells;
  std::ranges::sort(cells, {}, &Cell::dataset);
  const SharedReference reference = shared_reference(a.reference, files);
  std::vector<EvaluatedFile> all(cells.size());
  parallel_for_tasks(
      cells.size(), [&](std::size_t i) { all[i] = evaluate_recorded(cells[i], files, reference); });
  return stored(std::move(files), std::move(all), source, visit);
}

Evaluations evaluate_in_memory(const EvalArguments& a,
                               RecordedFile reference,
                               const RecordedFile& estimate) {
  RecordedSweep files =
      recorded_sweep({{"reference", "estimate", "0", "reference", "estimate"}}, a);
  std::vector<EvaluatedFile> all;
  all.push_back(evaluate_poses(files.cells.front(), files, {std::move(reference)}, estimate));
  return stored(std::move(files), std::move(all), {}, {});
}

}  // namespace loopbench::harness
