#include "harness/cluster/scripts.hpp"

#include <fmt/format.h>

#include "harness/text/shell.hpp"

namespace loopbench::harness {
namespace {

/// For shellcheck: texts in single quotes can look like expressions, a path with a line feed like a
/// mistake, and functions that only traps call like unreachable ones.
constexpr const char* kChecked = "# shellcheck disable=SC2016,SC2289,SC2317\n";

/// "#SBATCH --NAME=VALUE" for a value that is set. sbatch reads the rest of the line, so values
/// contain no white space, see with_settings().
std::string sbatch_line(const std::string& name, const std::string& value) {
  return value.empty() ? "" : "#SBATCH --" + name + "=" + value + "\n";
}

std::string sbatch_lines(const ClusterSettings& settings) {
  return sbatch_line("partition", settings.partition) + sbatch_line("account", settings.account) +
         sbatch_line("qos", settings.qos) + sbatch_line("constraint", settings.constraint);
}

std::string run_words(const SubmittedSweep& sweep) {
  std::string out = shell_quoted(sweep.program.string()) + " run " +
                    shell_quoted(sweep.config.string()) + " --out " +
                    shell_quoted(sweep.out.string());
  for (const std::string& word : sweep.options) out += " " + shell_quoted(word);
  return out;
}

std::string merge_lines(const SubmittedSweep& sweep) {
  const std::string out = shell_quoted(sweep.out.string());
  return "shopt -s nullglob\n"
         "stores=(" +
         out +
         "/shards/*/results.sqlite)\n"
         "((${#stores[@]})) || { echo 'loopbench: no shard has a store' >&2; exit 2; }\n" +
         shell_quoted(sweep.program.string()) + " merge --add \"${stores[@]}\" -o " + out + "\n";
}

}  // namespace

std::string job_name(const std::string& name) {
  constexpr std::size_t kLongest = 60;
  std::string out = name.substr(0, kLongest);
  for (char& c : out) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
    if (!is_plain) c = '_';
  }
  return out.empty() ? "loopbench" : out;
}

std::string slurm_shard_script(const SubmittedSweep& sweep, const ClusterSettings& settings) {
  constexpr std::int64_t kMebibyte = 1 << 20;
  const std::int64_t bytes = limit_bytes(settings.memory);
  return fmt::format("#!/bin/bash\n#SBATCH --job-name={}\n#SBATCH --array=1-{}\n",
                     job_name(sweep.name),
                     settings.array) +
         "#SBATCH --output=logs/%A_%a.txt\n#SBATCH --open-mode=append\n#SBATCH --requeue\n"
         "#SBATCH --nodes=1\n#SBATCH --ntasks=1\n" +
         fmt::format("#SBATCH --cpus-per-task={}\n#SBATCH --signal=B:USR1@{}\n",
                     settings.cores,
                     settings.signal) +
         sbatch_line("time", settings.time) +
         (bytes == 0 ? ""
                     : fmt::format("#SBATCH --mem={}M\n", (bytes + kMebibyte - 1) / kMebibyte)) +
         sbatch_lines(settings) +
         fmt::format("# Written by loopbench submit: task I runs shard I of {}.\n",
                     settings.array) +
         kChecked +
         "set -u\n"
         "limit=0 ended=0 waited=-1 code=0 shard='' late=''\n"
         "stop_shard() { [[ -z $shard ]] || kill -TERM \"$shard\" 2>/dev/null; }\n" +
         fmt::format(
             "abandon_cells() {{\n"
             "  sleep {} & nap=$!\n"
             "  trap 'kill \"$nap\"; exit' TERM\n"
             "  wait \"$nap\"\n"
             "  kill -INT \"$shard\"\n"
             "}}\n",
             settings.signal - settings.signal / 4) +
         "# Cancelled or requeued: running cells are finished. Before the time limit: also, and "
         "all\n"
         "# others run after the requeue, as those that would exceed the limit.\n"
         "trap 'ended=1; stop_shard' TERM\n"
         "trap 'limit=1; stop_shard' USR1\n" +
         run_words(sweep) +
         fmt::format(
             " --shard \"$SLURM_ARRAY_TASK_ID/{}\" --jobs \"${{SLURM_CPUS_PER_TASK:-{}}}\" &\n",
             settings.array,
             settings.cores) +
         "shard=$!\n"
         "((limit + ended)) && stop_shard  # the signal came before the number was known\n"
         "until ((limit + ended == waited)); do  # a signal ends the wait\n"
         "  waited=$((limit + ended)) code=0\n"
         "  ((limit)) && [[ -z $late ]] && { abandon_cells 2>/dev/null & late=$!; }\n"
         "  wait \"$shard\" || code=$?\n"
         "done\n"
         "[[ -z $late ]] || kill \"$late\" 2>/dev/null\n"
         "# 130: interrupted; 143: before it could be. Not forever, if a shard makes no progress.\n"
         "if ((limit && !ended && (code == 130 || code == 143) && ${SLURM_RESTART_COUNT:-0} < "
         "1000)); then\n"
         "  exec scontrol requeue \"${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}\"\n"
         "fi\n"
         "((code == 1)) && exit 0  # failed cells are results, too\n"
         "exit \"$code\"\n";
}

std::string slurm_merge_script(const SubmittedSweep& sweep, const ClusterSettings& settings) {
  return "#!/bin/bash\n#SBATCH --job-name=" + job_name(sweep.name).substr(0, 50) + "-merge\n" +
         "#SBATCH --output=logs/%j-merge.txt\n#SBATCH --open-mode=append\n#SBATCH --requeue\n"
         "#SBATCH --nodes=1\n#SBATCH --ntasks=1\n#SBATCH --cpus-per-task=1\n" +
         sbatch_line("time", settings.time) + sbatch_lines(settings) +
         "# Written by loopbench submit: merges the stores of all shards.\n" + kChecked +
         "set -eu\n" + merge_lines(sweep);
}

std::string local_script(const SubmittedSweep& sweep, const ClusterSettings& settings) {
  return std::string(
             "#!/bin/bash\n"
             "# Written by loopbench submit: runs all shards at once, then merges their "
             "stores.\n") +
         kChecked +
         "set -u\n"
         "mkdir -p logs\n"
         "shards=() stopped=0\n"
         "trap 'stopped=1; ((${#shards[@]} == 0)) || kill -TERM \"${shards[@]}\" 2>/dev/null' TERM "
         "INT\n" +
         fmt::format("for ((i = 1; i <= {}; ++i)); do\n  ", settings.array) + run_words(sweep) +
         fmt::format(" --shard \"$i/{}\" --jobs {} >>\"logs/shard-$i.txt\" 2>&1 &\n",
                     settings.array,
                     settings.cores) +
         "  shards+=(\"$!\")\n"
         "  ((stopped)) && { kill -TERM \"${shards[@]}\"; break; }\n"
         "done\n"
         "while [[ -n $(jobs -pr) ]]; do wait; done\n"
         "((stopped)) && exit 130\n" +
         merge_lines(sweep);
}

}  // namespace loopbench::harness
