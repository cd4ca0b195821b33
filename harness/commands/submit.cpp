#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cctype>
#include <charconv>
#include <map>

#include "datasets/core/error.hpp"
#include "harness/catalogue/load_sequence.hpp"
#include "harness/cluster/progress_file.hpp"
#include "harness/cluster/run_program.hpp"
#include "harness/cluster/scripts.hpp"
#include "harness/cluster/submission.hpp"
#include "harness/commands/cluster.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/config_path.hpp"
#include "harness/commands/standard_output.hpp"
#include "harness/config/data_root.hpp"
#include "harness/config/read_sweep.hpp"
#include "harness/model/cells.hpp"
#include "harness/shards/run_part.hpp"
#include "harness/text/printable.hpp"
#include "harness/text/shell.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench::harness {
namespace {

struct SubmitArguments {
  std::string config;
  std::string only;
  std::string data;
  std::string out;
  std::string costs;
  std::vector<std::string> plugins;
  bool missing = false;
  bool pin_instructions = false;
  bool dry_run = false;
  std::map<std::string, std::string> settings;  ///< those given as options
};

std::string absolute(const std::string& path) { return std::filesystem::absolute(path).string(); }

/// Words of `loopbench run` besides the config, the folder and the shard.
std::vector<std::string> run_options(const SubmitArguments& arguments,
                                     const ClusterSettings& settings) {
  std::vector<std::string> out;
  if (!arguments.data.empty()) out.insert(out.end(), {"--data", absolute(arguments.data)});
  if (!arguments.costs.empty()) out.insert(out.end(), {"--costs", absolute(arguments.costs)});
  if (!arguments.only.empty()) out.push_back("--only=" + arguments.only);
  if (!settings.stage.empty()) out.push_back("--stage=" + settings.stage);
  if (arguments.missing) out.emplace_back("--missing");
  if (arguments.pin_instructions) out.emplace_back("--pin-instructions");
  for (const std::string& plugin : arguments.plugins) {
    out.insert(out.end(), {"--plugin", absolute(plugin)});
  }
  return out;
}

/// The config's settings, replaced by the given options.
ClusterSettings settings_of(const SubmitArguments& arguments, const std::string& config) {
  ClusterSettings out = cluster_settings(config, user_cluster_file());
  for (const OptionInfo& option : describe(ClusterSettings{})) {
    const auto given = arguments.settings.find(option.name);
    if (given == arguments.settings.end() || given->second.empty()) continue;
    const std::string& text = given->second;
    Param value = text;
    std::int64_t number = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool is_number = error == std::errc() && rest == text.data() + text.size();
    if (!option.is_text && is_number) value = number;
    out = with_settings(out, {{option.name, value}});
  }
  return out;
}

/// A cell must be able to reach its own limits before the job reaches its.
void check_limits(const Sweep& sweep, const ClusterSettings& settings) {
  if (settings.engine == Engine::local) return;
  const auto time = static_cast<double>(limit_seconds(settings.time));
  const double needed = sweep.limits.seconds + static_cast<double>(settings.signal);
  if (time > 0.0 && (sweep.limits.seconds == 0.0 || needed >= time)) {
    throw InputError(fmt::format(
        "{}: a cell can take {} (limits.seconds), and a shard ends {} s before its limit of {:g} s "
        "(time); increase time or reduce limits.seconds",
        sweep.config.string(),
        sweep.limits.seconds == 0.0 ? "any time" : fmt::format("{:g} s", sweep.limits.seconds),
        settings.signal,
        time));
  }
  const std::int64_t memory = limit_bytes(settings.memory);
  if (memory > 0 && (sweep.limits.memory == 0 || sweep.limits.memory > memory)) {
    throw InputError(fmt::format(
        "{}: a cell can take {} (limits.memory), but a shard has {} MiB (memory); increase memory "
        "or reduce limits.memory",
        sweep.config.string(),
        sweep.limits.memory == 0 ? "any memory" : fmt::format("{} MiB", sweep.limits.memory >> 20),
        memory >> 20));
  }
}

/// Submits a script and returns Slurm's number of the job.
std::string submitted(std::vector<std::string> words, const std::filesystem::path& folder) {
  words.insert(words.begin(), {"sbatch", "--parsable"});
  const ProgramResult result = run_program(words, folder);
  if (result.exit_code == 127) throw InputError("sbatch: cannot be started; is Slurm installed?");
  const std::string number = result.out.substr(0, result.out.find_first_of(";\n"));
  if (result.exit_code != 0 || number.empty()) throw InputError("sbatch: did not accept the job");
  return number;
}

/// Number of cells that the jobs run. Throws InputError if `--missing` has no store to complete.
std::size_t submitted_cells(const SubmitArguments& arguments,
                            const Sweep& sweep,
                            const Catalogue& known,
                            const std::filesystem::path& out,
                            const Source& source) {
  const std::vector<bool> with_seed = seeded(sweep, known);
  const std::vector<Cell> selected = cells(sweep, with_seed, arguments.only);
  if (selected.empty()) throw InputError(arguments.config + ": no cells to run");
  if (!arguments.missing) return selected.size();
  const DataRoot root = data_root(sweep, arguments.data);
  CellKeys keys(sweep, known, root, build_id(source.code));
  PartArguments part;
  part.missing = part.dry_run = true;
  return select_part(part, keys, cells(sweep, with_seed, ""), selected, known, root, out)
      .planned.size();
}

/// Throws InputError while jobs of an earlier submission can write to its stores.
void require_no_jobs(const std::filesystem::path& out, Engine engine) {
  if (!std::filesystem::exists(out / "submission.txt")) return;
  const Submission earlier = read_submission(out);
  if (earlier.engine != engine) return;
  const bool has_jobs = engine == Engine::slurm ? queued_tasks(earlier) != "" : is_running(earlier);
  if (!has_jobs) return;
  throw InputError(
      fmt::format("{}: jobs of an earlier submission have not ended; wait for them (`{} watch`) or "
                  "end them (`{} cancel`)",
                  out.string(),
                  program_name(),
                  program_name()));
}

int submit(const SubmitArguments& arguments, const Source& source) {
  const std::string config = absolute(config_path(arguments.config));
  const std::vector<std::filesystem::path> plugins(arguments.plugins.begin(),
                                                   arguments.plugins.end());
  const Catalogue known = catalogue(with_config_plugins(plugins, config));
  const Sweep sweep = read_sweep(config, known, arguments.data);
  const ClusterSettings settings = settings_of(arguments, config);
  check_limits(sweep, settings);
  const std::filesystem::path out =
      absolute(arguments.out.empty() ? "results/" + sweep.name : arguments.out);
  const std::size_t count = submitted_cells(arguments, sweep, known, out, source);
  std::error_code error;
  const SubmittedSweep job{sweep.name,
                           std::filesystem::read_symlink("/proc/self/exe", error),
                           config,
                           out,
                           run_options(arguments, settings)};
  const bool is_slurm = settings.engine == Engine::slurm;
  const std::string script =
      is_slurm ? slurm_shard_script(job, settings) : local_script(job, settings);
  const std::string merge = is_slurm ? slurm_merge_script(job, settings) : "";
  if (arguments.dry_run) {
    fmt::print("{}{}{}", script, is_slurm ? "\n" : "", merge);
    return kExitOk;
  }
  if (count == 0) {
    fmt::print("no cells are missing\n");
    return kExitOk;
  }
  require_no_jobs(out, settings.engine);
  std::filesystem::create_directories(out / "logs");
  remove_progress(out);
  write_result(out / "shards.sh", script);
  if (is_slurm) write_result(out / "merge.sh", merge);
  Submission record{
      settings.engine, count, static_cast<std::size_t>(settings.array), "", "", 0, ""};
  if (is_slurm) {
    record.job = submitted({"shards.sh"}, out);
    record.merge_job = submitted({"--dependency=afterany:" + record.job, "merge.sh"}, out);
  } else {
    record.process = start_program({"bash", "shards.sh"}, out, out / "logs" / "local.txt");
    record.started = start_of_process(record.process);
  }
  write_submission(record, out);
  const std::string folder = shell_quoted(out.string());
  fmt::print("{} cells in {} shards{}\nnext:\n  {} watch {}\n  {} cancel {}\n",
             count,
             settings.array,
             is_slurm ? ", jobs " + record.job + " and " + record.merge_job
                      : fmt::format(", process {}", record.process),
             program_name(),
             folder,
             program_name(),
             folder);
  return kExitOk;
}

}  // namespace

void add_submit(CLI::App& app, int& exit_code, const Source& source) {
  auto arguments = std::make_shared<SubmitArguments>();
  CLI::App* command = app.add_subcommand(
      "submit", "Run the shards of a sweep as jobs of a cluster, or as processes");
  command
      ->add_option(
          "config", arguments->config, "YAML file, or the name of an installed config: quickstart")
      ->required();
  for (const OptionInfo& option : describe(ClusterSettings{})) {
    const std::string fallback = to_text(option.value);
    std::string help = option.help + (fallback.empty() ? "" : "; default: " + fallback);
    help.front() = static_cast<char>(std::toupper(help.front()));
    CLI::Option* added =
        command->add_option("--" + option.name, arguments->settings[option.name], help)
            ->type_name(option.is_text ? "TEXT" : "NUMBER");
    if (option.name == "engine") added->check(CLI::IsMember({"slurm", "local"}));
  }
  command->add_flag("--dry-run", arguments->dry_run, "Print the scripts without submitting them");
  command->add_flag("--missing", arguments->missing, "Only cells that the store in --out lacks");
  command->add_flag("--pin-instructions",
                    arguments->pin_instructions,
                    "Use the code paths of old processors on all nodes, see `run`");
  command->add_option("--only", arguments->only, "Only cells whose 'SEQUENCE / METHOD' matches")
      ->type_name("REGEX");
  command->add_option("--costs", arguments->costs, "Balance the shards by the times in a store")
      ->type_name("STORE");
  command->add_option("--data", arguments->data, "Folder with real datasets")
      ->envname("LOOPBENCH_DATA")
      ->type_name("DIR");
  command->add_option("--out", arguments->out, "Output folder (default: results/CONFIG)")
      ->type_name("DIR");
  command->add_option("--plugin", arguments->plugins, "Shared object with additional methods")
      ->type_name("FILE");
  command->footer(
      "Settings are read from ~/.config/loopbench/cluster.yaml, then from `cluster:` of the "
      "config, then from the options.");
  command->callback([arguments, source, &exit_code] { exit_code = submit(*arguments, source); });
}

}  // namespace loopbench::harness
