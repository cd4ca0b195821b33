#include "harness/run/run_cell.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <numeric>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "harness/base/system_file.hpp"
#include "harness/catalogue/external_methods.hpp"
#include "harness/catalogue/floating_point_guard.hpp"
#include "harness/catalogue/server.hpp"
#include "harness/run/add_scores.hpp"
#include "harness/run/check_output.hpp"
#include "harness/run/estimate_files.hpp"
#include "harness/run/summarise_sequence.hpp"
#include "metrics/trajectory/tracking_gaps.hpp"

namespace loopbench::harness {
namespace {

/// An estimate as a method returns it.
struct Estimate {
  const Curve& curve;
  const std::vector<Matrix6>& covariances;  ///< one per keyframe; empty: none stated
};

metrics::Context context_of(const Sequence& sequence,
                            const Trajectory& at_keyframes,
                            const Estimate& estimate,
                            metrics::Times times,
                            const metrics::Protocol& protocol) {
  return {.reference = &sequence.reference,
          .estimate = &at_keyframes,
          .problem = &sequence.problem,
          .curve = &estimate.curve,
          .times = times,
          .protocol = protocol,
          .loop_candidates = &sequence.loop_candidates,
          .estimate_covariances = estimate.covariances.empty() ? nullptr : &estimate.covariances};
}

/// Whether all positions are equal to within 1e-9 of the reference's largest distance from its
/// first one. False for fewer than three poses, and for a reference at rest. O(n).
bool has_equal_positions(const Trajectory& estimate, const Trajectory& reference) {
  constexpr double kTolerance = 1e-9;  // of the size
  if (reference.size() < 3 || reference.size() != estimate.size()) return false;
  double size = 0.0;
  double difference = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const auto& position = reference[i].world_from_body.translation;
    size = std::max(size, (position - reference.front().world_from_body.translation).norm());
    difference = std::max(difference, (estimate[i].world_from_body.translation - position).norm());
  }
  return size > 0.0 && difference <= kTolerance * size;
}

using Clock = std::chrono::steady_clock;

/// CPU time of all threads of this process [s].
double process_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Time that this thread was ready and had no processor [s]; none without the kernel's statistics.
std::optional<double> seconds_without_processor() {
  std::istringstream in(read_system_file("/proc/self/schedstat"));
  double running = 0.0, waiting = 0.0;
  if (!(in >> running >> waiting)) return std::nullopt;
  return 1e-9 * waiting;
}

/// Largest resident size of this process [bytes].
std::int64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{1024} * usage.ru_maxrss;
}

/// What the harness has used while a program ran is not the program's.
void use_costs_of_program(CellResult& result, const methods::Report& report) {
  const auto count = [&](const char* name) {
    const auto found = std::ranges::find(report.counts, name, &methods::Count::name);
    return found == report.counts.end() ? std::nullopt : std::optional(found->value);
  };
  if (const auto seconds = count(kProgramTime)) result.cpu_seconds.back() = *seconds;
  if (const auto memory = count(kProgramMemory)) {
    result.peak_memory = static_cast<std::int64_t>(*memory);
    result.added_memory.reset();
  }
}

/// A run that is shorter [s] mostly pays for the first access of a new process to its memory.
constexpr double kShortRun = 2e-3;

struct TimedRun {
  std::unique_ptr<const Curve> curve;
  methods::Report report;
  double seconds = 0.0;
  double cpu_seconds = 0.0;
};

TimedRun timed_run(const methods::Estimator& method, const Problem& problem) {
  TimedRun out;
  const double cpu_begin = process_cpu_seconds();
  const auto begin = Clock::now();
  out.curve = method.estimate(problem, out.report);
  const std::chrono::duration<double> took = Clock::now() - begin;
  out.seconds = std::max(0.0, took.count() - exchange_seconds(out.report));
  out.cpu_seconds = process_cpu_seconds() - cpu_begin;
  return out;
}

/// Hash of the poses at the keyframes and the frames between them; empty if some are invalid, which
/// check_curve() reports.
std::string hash_of_curve(const Curve* curve, const Problem& problem) try {
  if (curve == nullptr) return "";
  const CheckedCurve checked(*curve);
  return hash_of_poses(checked.sample(stamps(problem.keyframes))) +
         hash_of_poses(checked.sample(stamps(problem.frames)));
} catch (const std::exception&) {
  return "";
}

/// Whether the runs of a cell are enough: the standard error of the mean CPU time is below the
/// precision, or they took long.
bool are_enough_runs(const CellResult& result, double precision) {
  constexpr std::size_t kFewest = 5;  // for a median that one disturbance does not change
  constexpr double kMost = 2.0;       // CPU time [s]
  const std::vector<double>& runs = result.cpu_seconds;
  if (precision == 0.0 || runs.size() < kFewest) return false;
  if (std::accumulate(runs.begin(), runs.end(), 0.0) > kMost) return true;
  return variation(runs).value_or(0.0) < precision * std::sqrt(static_cast<double>(runs.size()));
}

/// Runs and measures the method; memory is that of the first run, measured outside the timed part.
/// Every run asks a new process of a program that serves, so that no answer is from its memory.
/// The times of a short first run are replaced by those of another run, because this process is
/// new; its result is kept. Results of these runs that are not bit-identical are noted.
std::unique_ptr<const Curve> timed(CellResult& result,
                                   const methods::Estimator& method,
                                   const Problem& problem,
                                   const Sweep& sweep) {
  const FloatingPointGuard guard;
  const auto waited = seconds_without_processor();
  const auto begin = Clock::now();
  const std::int64_t before = peak_memory();
  TimedRun last;
  std::set<std::string> results;
  std::size_t warm_runs = 0;
  for (int run = 0; run < sweep.timing && !are_enough_runs(result, sweep.precision); ++run) {
    if (run > 0) end_servers();
    last = {};  // so that the destruction of its curve is not timed with the next run
    last = timed_run(method, problem);
    check_report(last.report);
    const bool is_first = run == 0 && !uses_exchange(last.report);
    if (is_first && last.seconds < kShortRun) {
      const TimedRun warm = timed_run(method, problem);
      results.insert(hash_of_curve(warm.curve.get(), problem));
      ++warm_runs;
      last.seconds = warm.seconds;
      last.cpu_seconds = warm.cpu_seconds;
      last.report.phases = warm.report.phases;
    }
    result.seconds.push_back(last.seconds);
    result.cpu_seconds.push_back(last.cpu_seconds);
    if (run == 0) {
      result.peak_memory = peak_memory();
      result.added_memory = *result.peak_memory - before;
    }
    use_costs_of_program(result, last.report);
    if (sweep.timing > 1 || warm_runs > 0) results.insert(hash_of_curve(last.curve.get(), problem));
  }
  if (const auto now = seconds_without_processor(); waited && now) {
    const std::chrono::duration<double> took = Clock::now() - begin;
    result.waiting = std::clamp((*now - *waited) / took.count(), 0.0, 1.0);
  }
  result.worker.stated = wall_beside_stated(last.report).has_value();
  result.report = std::move(last.report);
  if (results.size() > 1) {
    result.report.notes.push_back(
        fmt::format("{}{} runs on the same input gave {} different trajectories",
                    kNondeterministic,
                    result.seconds.size() + warm_runs,
                    results.size()));
  }
  return std::move(last.curve);
}

/// Computes every metric under the protocol and times of `row`.
void evaluate_curve(CellResult& result,
                    const ScoreResult& row,
                    const Sweep& sweep,
                    const Sequence& sequence,
                    const Estimate& estimate,
                    const Catalogue& catalogue) {
  const std::vector<double> keyframe_stamps = stamps(sequence.problem.keyframes);
  const Curve& curve = estimate.curve;
  const Trajectory at_keyframes = curve.sample(keyframe_stamps);
  const std::vector<double> tracked = metrics::tracked_stamps(sequence.problem);
  const metrics::Protocol& protocol = sweep.protocols[row.protocol].rules;
  ScoreResult failure = row;
  catch_errors(failure, [&] {
    metrics::Evaluation evaluation =
        metrics::evaluate(sequence.reference, curve, keyframe_stamps, row.times, protocol, tracked);
    evaluation.context = context_of(sequence, at_keyframes, estimate, row.times, protocol);
    // Noise-free data equal the reference without any method.
    const bool has_moved = !has_equal_positions(at_keyframes, sequence.problem.keyframes);
    if (!result.oracle_method && has_moved &&
        has_equal_positions(evaluation.estimate, evaluation.reference)) {
      result.oracle_method = true;
      result.report.notes.emplace_back("oracle (equals the reference)");
    }
    add_scores(result, row, evaluation, sweep, catalogue);
    const bool densest = row.times == metrics::Times::dense ||
                         std::ranges::count(sweep.times, metrics::Times::dense) == 0;
    if (sweep.traces && row.protocol == 0 && densest) {
      result.trace = cell_trace(evaluation, row.times, trace_origin(sequence));
      add_pose_values(result, row);
    }
  });
  // No pairs, or no unique alignment.
  if (failure.status != Status::ok) add_failure(result, failure, sweep);
}

/// Computes metrics that need only the problem; once, since they depend on neither pairs nor times.
void add_scores_without_reference(CellResult& result,
                                  const Sweep& sweep,
                                  const Sequence& sequence,
                                  const Estimate& estimate,
                                  const Catalogue& catalogue) {
  const Trajectory at_keyframes = estimate.curve.sample(stamps(sequence.problem.keyframes));
  for (std::size_t p = 0; p < sweep.protocols.size(); ++p) {
    metrics::Evaluation evaluation;
    evaluation.protocol = sweep.protocols[p].rules;
    evaluation.context = context_of(
        sequence, at_keyframes, estimate, metrics::Times::keyframes, evaluation.protocol);
    const ScoreResult row{p, metrics::Times::keyframes, "", "", {}, {}, Status::ok, ""};
    for (const MetricChoice& choice : sweep.metrics) {
      if (find_metric(catalogue, choice.metric.name).needs_reference) continue;
      add_scores_of(result, choice, row, evaluation, sweep, catalogue);
    }
  }
}

}  // namespace

CellResult run_cell(const Cell& cell,
                    const Sweep& sweep,
                    const Sequence& sequence,
                    const Catalogue& catalogue) {
  if (const auto own = with_alignment_of(cell.dataset, sweep)) {
    return run_cell(cell, *own, sequence, catalogue);
  }
  CellResult result;
  result.cell = cell;
  const MethodChoice& choice = sweep.methods[cell.method];
  result.oracle_method = uses_reference(choice, catalogue);
  catch_errors(result, [&] {
    if (result.oracle_method && lacks_rotations(sequence.reference)) {
      result.status = Status::declined;
      result.why = "reads the reference, which has positions without rotation";
      return;
    }
    const auto method = make_method(choice, catalogue, sequence.reference, command_setting(sweep));
    if (const std::string why = reason_to_decline(*method, sequence.problem); !why.empty()) {
      result.status = Status::declined;
      result.why = stored_reason(why);
      return;
    }
    const bool is_foreign = std::ranges::any_of(choice.stages, [&](const Choice& stage) {
      return !plugin_version(catalogue, "method", stage.name).empty();
    });
    // The method of a plugin can write through `const`, and metrics read the same.
    const Problem copy = is_foreign ? sequence.problem : Problem{};
    const std::unique_ptr<const Curve> curve =
        timed(result, *method, is_foreign ? copy : sequence.problem, sweep);
    check_span(curve.get(), sequence.problem.keyframes);
    const CheckedCurve checked(*curve);
    // Only metrics read them: they are neither sent to the sweep nor stored.
    const std::vector<Matrix6> covariances = std::exchange(result.report.covariances, {});
    check_covariances(covariances, sequence.problem.keyframes.size());
    const Estimate estimate{checked, covariances};
    save_estimate(cell, sweep, sequence, checked);
    if (sequence.reference.empty()) {
      result.why = "no reference to evaluate against";
      add_scores_without_reference(result, sweep, sequence, estimate, catalogue);
      checked.require_valid_so_far();
      return;
    }
    for (std::size_t p = 0; p < sweep.protocols.size(); ++p) {
      for (const metrics::Times times : sweep.times) {
        const ScoreResult row{p, times, "", "", {}, {}, Status::ok, ""};
        evaluate_curve(result, row, sweep, sequence, estimate, catalogue);
      }
    }
    checked.require_valid_so_far();
  });
  if (is_failure(result.status)) {  // scores of an invalid curve have no meaning
    result.scores.clear();
    result.trace = {};
  }
  return result;
}

}  // namespace loopbench::harness
