#include "harness/sweep/run/timed_runs.hpp"

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

#include "harness/sweep/catalogue/exchange.hpp"
#include "harness/sweep/catalogue/floating_point_guard.hpp"
#include "harness/sweep/catalogue/server.hpp"
#include "harness/sweep/process/system_file.hpp"
#include "harness/sweep/run/check_output.hpp"
#include "harness/sweep/run/summarise_sequence.hpp"

namespace loopbench::harness {
namespace {

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
void use_costs_of_program(CellResult& result, const ProgramCosts& costs) {
  if (!costs.is_measured) return;
  result.cpu_seconds.back() = costs.cpu_seconds;
  result.peak_memory = costs.peak_memory;
  result.added_memory.reset();
}

/// A run that is shorter [s] mostly pays for the first access of a new process to its memory.
constexpr double kShortRun = 2e-3;

struct TimedRun {
  std::unique_ptr<const Curve> curve;
  methods::Report report;
  ProgramCosts programs;
  double seconds = 0.0;
  double cpu_seconds = 0.0;
};

TimedRun timed_run(const methods::Estimator& method, const Problem& problem) {
  TimedRun out;
  program_costs() = {};
  const double cpu_begin = process_cpu_seconds();
  const auto begin = Clock::now();
  out.curve = method.estimate(problem, out.report);
  const std::chrono::duration<double> took = Clock::now() - begin;
  out.cpu_seconds = process_cpu_seconds() - cpu_begin;
  out.programs = program_costs();
  out.seconds = std::max(0.0, took.count() - out.programs.exchange_seconds);
  settle_costs(out.report);
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

}  // namespace

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
    const bool is_first = run == 0 && !last.programs.is_measured;
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
    use_costs_of_program(result, last.programs);
    if (sweep.timing > 1 || warm_runs > 0) results.insert(hash_of_curve(last.curve.get(), problem));
  }
  if (const auto now = seconds_without_processor(); waited && now) {
    const std::chrono::duration<double> took = Clock::now() - begin;
    result.waiting = std::clamp((*now - *waited) / took.count(), 0.0, 1.0);
  }
  result.worker.stated = last.programs.stated_run.has_value();
  result.report = std::move(last.report);
  if (results.size() > 1) {
    result.notes.push_back(
        {.kind = NoteKind::nondeterministic,
         .severity = Severity::caution,
         .numbers = {{"runs", static_cast<double>(result.seconds.size() + warm_runs)},
                     {"trajectories", static_cast<double>(results.size())}}});
  }
  return std::move(last.curve);
}

}  // namespace loopbench::harness
