#include "harness/eval/evaluate_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>

#include "datasets/core/parallel.hpp"
#include "harness/base/write_file.hpp"
#include "harness/eval/common_parts.hpp"
#include "harness/model/recorded_run.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

/// With the names as given.
std::vector<RecordedRun> runs_of(const EvalArguments& a) {
  std::vector<RecordedRun> out = labelled_runs(a.reference, a.estimates, a.sequence);
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

/// Runs are one observation only if the outputs of all methods are equal.
void join_contents(std::vector<EvaluationResult>& results) {
  std::map<std::int64_t, std::map<std::string, std::string>> contents;  // by repeat and method
  for (const EvaluationResult& result : results) {
    const Record& first = result.records.front();
    contents[first.repeat][first.method] = std::string(first.content);
  }
  for (EvaluationResult& result : results) {
    const std::string content = recorded_content(contents.at(result.records.front().repeat));
    for (Record& record : result.records) record.content = content;
  }
}

/// The fields that all records of a cell have in common.
Record record_of_cell(const CellResult& result, const Sweep& sweep) {
  Record out;
  out.cell = static_cast<std::int64_t>(result.cell.index);
  out.sequence = sweep.datasets[result.cell.dataset].label;
  out.repeat = result.cell.repeat;
  out.method = sweep.methods[result.cell.method].label;
  out.oracle = result.oracle_method;
  out.milliseconds = result.seconds.empty() ? std::numeric_limits<double>::quiet_NaN()
                                            : 1e3 * metrics::median(result.seconds);
  out.is_stated = result.worker.stated;
  out.status = result.status;
  out.why = result.why;
  if (result.metadata) {
    out.closures = result.metadata->closures;
    out.oracle_closures = result.metadata->oracle_closures;
    out.group = result.metadata->group;
    out.content = result.metadata->content;
  }
  return out;
}

/// One record for each score of a cell of the sweep, or one without a metric if it has none.
std::vector<Record> records_of(const CellResult& result, const Sweep& sweep) {
  const Record cell = record_of_cell(result, sweep);
  if (result.scores.empty()) return {cell};
  std::vector<Record> out;
  for (const ScoreResult& score : result.scores) {
    Record& r = out.emplace_back(cell);
    r.protocol = sweep.protocols[score.protocol].label();
    r.protocol_version = sweep.protocols[score.protocol].version;
    r.times = to_text(score.times);
    r.metric = score.metric;
    r.label = score.label;
    r.relation = score.score.relation;
    r.axis = score.score.axis;
    r.unit = score.score.unit;
    r.better = score.score.better;
    r.target = score.score.target;
    r.statistics = score.score.statistics;
    r.pairs = static_cast<std::int64_t>(score.coverage.pairs);
    r.possible = static_cast<std::int64_t>(score.coverage.possible);
    r.span = score.coverage.span;
    r.status = score.status;
    r.why = score.why;
  }
  return out;
}

/// The only record of an evaluation that failed.
Record failed_record(CellResult result, const EvaluationResult& own, const Sweep& sweep) {
  result.scores.clear();
  result.status = Status::failed;
  result.why = own.why_failed;
  Record out = records_of(result, sweep).front();
  out.protocol = own.protocol.label();
  out.protocol_version = own.protocol.version;
  return out;
}

/// The results with their records.
std::vector<EvaluationResult> results_of(std::vector<EvaluatedFile> all, const Sweep& sweep) {
  std::vector<EvaluationResult> out;
  for (EvaluatedFile& file : all) {
    const std::vector<Record> records = records_of(file.result, sweep);
    for (EvaluationResult& own : file.protocols) {
      if (!own.why_failed.empty()) own.records = {failed_record(file.result, own, sweep)};
      for (const Record& record : records) {
        const bool is_own = own.why_failed.empty() && record.protocol == own.protocol.label();
        if (is_own) own.records.push_back(record);
      }
      out.push_back(std::move(own));
    }
  }
  if (sweep.datasets.size() > 1) join_contents(out);
  return out;
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

}  // namespace

std::vector<EvaluationResult> evaluate_files(
    const EvalArguments& a,
    const std::function<void(const RecordedSweep&, const std::vector<EvaluatedFile>&)>& visit) {
  check_estimates(a);
  std::vector<std::filesystem::path> inputs{a.times, a.reference};
  inputs.insert(inputs.end(), a.estimates.begin(), a.estimates.end());
  reject_overwriting(inputs, a.per_pose);
  std::vector<RecordedRun> labelled = runs_of(a);
  if (a.common.value_or(false)) set_common_times(labelled, a);
  const RecordedSweep sweep = recorded_sweep(std::move(labelled), a);
  check_stamp_options(a, sweep.runs);
  std::vector<Cell> cells = sweep.cells;
  std::ranges::sort(cells, {}, &Cell::dataset);
  const SharedReference reference = shared_reference(a.reference, sweep);
  std::vector<EvaluatedFile> all(cells.size());
  parallel_for_tasks(
      cells.size(), [&](std::size_t i) { all[i] = evaluate_recorded(cells[i], sweep, reference); });
  require_evaluated(all);
  if (!a.min_coverage) check_coverage(all);
  if (visit) visit(sweep, all);
  return results_of(std::move(all), sweep.sweep);
}

std::vector<EvaluationResult> evaluate_in_memory(const EvalArguments& a,
                                                 RecordedFile reference,
                                                 const RecordedFile& estimate) {
  const RecordedSweep sweep =
      recorded_sweep({{"reference", "estimate", "0", "reference", "estimate"}}, a);
  std::vector<EvaluatedFile> all;
  all.push_back(evaluate_poses(sweep.cells.front(), sweep, {std::move(reference)}, estimate));
  require_evaluated(all);
  return results_of(std::move(all), sweep.sweep);
}

}  // namespace loopbench::harness
