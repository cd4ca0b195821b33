#include "harness/cluster/submission.hpp"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "datasets/core/error.hpp"
#include "harness/cluster/run_program.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench::harness {
namespace {

std::filesystem::path submission_file(const std::filesystem::path& out) {
  return out / "submission.txt";
}

/// "4 running, 2 pending" from a state in each line, such as "CANCELLED by 0".
std::string counted_states(const std::string& lines) {
  std::map<std::string, std::size_t> counts;
  std::istringstream in(lines);
  for (std::string line; std::getline(in, line);) {
    std::string state = line.substr(0, line.find_first_of(" +|"));
    std::ranges::transform(
        state, state.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
    if (!state.empty()) ++counts[state];
  }
  std::string out;
  for (const auto& [state, count] : counts) {
    out += (out.empty() ? "" : ", ") + std::to_string(count) + " " + state;
  }
  return out;
}

std::string jobs_of(const Submission& submission) {
  return submission.job + (submission.merge_job.empty() ? "" : "," + submission.merge_job);
}

}  // namespace

void write_submission(const Submission& submission, const std::filesystem::path& out) {
  write_result(submission_file(out),
               "engine " + to_text(submission.engine) + "\ncells " +
                   std::to_string(submission.cells) + "\nshards " +
                   std::to_string(submission.shards) + "\njob " + submission.job + "\nmerge " +
                   submission.merge_job + "\nprocess " + std::to_string(submission.process) +
                   "\nstarted " + submission.started + "\n");
}

Submission read_submission(const std::filesystem::path& out) {
  const std::filesystem::path file = submission_file(out);
  std::ifstream in(file);
  if (!in) {
    throw InputError(file.string() +
                     ": file not found, expected the record that `loopbench submit` writes");
  }
  std::map<std::string, std::string> values;
  for (std::string line; std::getline(in, line);) {
    const std::size_t space = std::min(line.find(' '), line.size());
    values[line.substr(0, space)] = line.substr(std::min(space + 1, line.size()));
  }
  Submission submission;
  const auto engine = from_text<Engine>(values["engine"]);
  std::istringstream(values["cells"]) >> submission.cells;
  std::istringstream(values["shards"]) >> submission.shards;
  std::istringstream(values["process"]) >> submission.process;
  submission.job = values["job"];
  submission.merge_job = values["merge"];
  submission.started = values["started"];
  const bool is_slurm = engine == Engine::slurm;
  if (!engine || submission.cells == 0 || (is_slurm && submission.job.empty())) {
    throw InputError(file.string() + ": is not a record of `loopbench submit`");
  }
  submission.engine = *engine;
  return submission;
}

bool is_running(const Submission& submission) {
  return submission.process > 1 && !submission.started.empty() &&
         start_of_process(submission.process) == submission.started;
}

std::optional<std::string> queued_tasks(const Submission& submission) {
  // All jobs of the user: squeue also fails when it is asked for jobs that have ended.
  const ProgramResult listed = run_program(
      {"squeue", "--noheader", "--array", "--format=%F %T", "--user=" + std::to_string(getuid())},
      ".",
      true);
  if (listed.exit_code == 127) throw InputError("squeue: cannot be started; is Slurm installed?");
  if (listed.exit_code != 0) return std::nullopt;
  std::istringstream in(listed.out);
  std::string states;
  for (std::string job, state; in >> job >> state;) {
    if (job == submission.job || job == submission.merge_job) states += state + "\n";
  }
  return counted_states(states);
}

std::string ended_tasks(const Submission& submission) {
  const ProgramResult listed = run_program({"sacct",
                                            "--noheader",
                                            "--allocations",
                                            "--parsable2",
                                            "--format=State",
                                            "--jobs=" + jobs_of(submission)},
                                           ".",
                                           true);
  return listed.exit_code == 0 ? counted_states(listed.out) : "";
}

void cancel(const Submission& submission) {
  if (submission.engine == Engine::local) {
    // The group of the script and its shards; each finishes its running cells.
    if (is_running(submission)) kill(-submission.process, SIGTERM);
    return;
  }
  std::vector<std::string> words{"scancel", submission.job};
  if (!submission.merge_job.empty()) words.push_back(submission.merge_job);
  if (run_program(words, ".").exit_code != 0) {
    throw InputError("scancel " + jobs_of(submission) + ": failed");
  }
}

}  // namespace loopbench::harness
