#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <optional>
#include <thread>

#include "harness/cluster/progress_file.hpp"
#include "harness/cluster/submission.hpp"
#include "harness/commands/cluster.hpp"
#include "harness/commands/commands.hpp"
#include "harness/text/printable.hpp"

namespace loopbench::harness {
namespace {

using WatchClock = std::chrono::steady_clock;

std::string duration_text(double seconds) {
  if (seconds < 120.0) return fmt::format("{:.0f} s", seconds);
  if (seconds < 7200.0) return fmt::format("{:.0f} min", seconds / 60.0);
  return fmt::format("{:.1f} h", seconds / 3600.0);
}

/// Prints the state of a submission repeatedly, with the rate since the first time.
class Watch {
 public:
  explicit Watch(const std::filesystem::path& out) : out_(out), submission_(read_submission(out)) {}

  /// Prints one line; whether jobs are left.
  bool step() {
    const bool is_slurm = submission_.engine == Engine::slurm;
    const std::string queued = is_slurm ? queued_tasks(submission_).value_or("squeue fails")
                               : is_running(submission_) ? "running"
                                                         : "";
    const CellCounts now = read_progress(out_);
    if (!first_) first_ = {now, WatchClock::now()};
    const double seconds =
        std::chrono::duration<double>(WatchClock::now() - first_->second).count();
    const double fresh = static_cast<double>(now.done) - static_cast<double>(first_->first.done);
    std::string line =
        fmt::format("{} of {} cells done, {} failed", now.done, submission_.cells, now.failed);
    if (fresh > 0.0 && seconds > 0.0) {
      const double rate = fresh / seconds;
      const double left = static_cast<double>(submission_.cells) - static_cast<double>(now.done);
      line += fmt::format("; {:.3g} cells/s, {} left", rate, duration_text(left / rate));
    }
    if (!queued.empty()) line += "; " + queued;
    if (is_slurm) {
      if (const std::string ended = ended_tasks(submission_); !ended.empty()) {
        line += "; all jobs: " + ended;
      }
    }
    fmt::print("{}\n", line);
    std::fflush(stdout);
    return !queued.empty();
  }

  /// Prints the result after the last job.
  int finish() const {
    const std::filesystem::path store = out_ / "results.sqlite";
    const bool is_merged = std::filesystem::exists(store);
    const bool is_complete = read_progress(out_).done >= submission_.cells;
    fmt::print("no jobs are left; {}{}\n",
               is_merged ? "merged store: " + printable(store.string()) : "no store was merged",
               is_complete ? "" : "; cells are missing, see the folder logs");
    return is_merged && is_complete ? kExitOk : kExitSomeCellsFailed;
  }

 private:
  std::filesystem::path out_;
  Submission submission_;
  std::optional<std::pair<CellCounts, WatchClock::time_point>> first_;
};

}  // namespace

void add_watch(CLI::App& app, int& exit_code) {
  struct Arguments {
    std::string out;
    double every = 10.0;
    bool once = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("watch", "Show cells done, rate, failures and time left of a submission");
  command->add_option("out", arguments->out, "Output folder of `submit`")->required();
  command->add_option("--every", arguments->every, "Interval between lines [s]")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  command->add_flag("--once", arguments->once, "Print one line and exit");
  command->callback([arguments, &exit_code] {
    Watch watch(arguments->out);
    while (watch.step()) {
      if (arguments->once) {
        exit_code = kExitOk;
        return;
      }
      std::this_thread::sleep_for(std::chrono::duration<double>(arguments->every));
    }
    exit_code = watch.finish();
  });
}

void add_cancel(CLI::App& app, int& exit_code) {
  auto out = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("cancel", "End the jobs of a submission; keep its results");
  command->add_option("out", *out, "Output folder of `submit`")->required();
  command->callback([out, &exit_code] {
    cancel(read_submission(*out));
    fmt::print("cancelled; finished cells are kept, and `submit` again continues\n");
    exit_code = kExitOk;
  });
}

}  // namespace loopbench::harness
