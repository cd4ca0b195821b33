#include "harness/sweep/catalogue/command_dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <set>
#include <string_view>

#include "datasets/pose_graph_dataset.hpp"
#include "datasets/trajectory_dataset.hpp"
#include "harness/sweep/catalogue/arguments.hpp"
#include "harness/sweep/catalogue/command.hpp"
#include "harness/sweep/catalogue/loading.hpp"
#include "harness/sweep/catalogue/program_output.hpp"
#include "harness/sweep/process/program.hpp"
#include "harness/sweep/text/hash.hpp"

namespace loopbench::harness {
namespace {

enum class UsedTrajectory { open, closed };
inline auto choices(UsedTrajectory) {
  return std::array{std::pair{"open", UsedTrajectory::open},
                    std::pair{"closed", UsedTrajectory::closed}};
}

constexpr double kMebibyte = 1 << 20;
constexpr std::int64_t kMostSeed = 0x7fffffff;  // that generators of all languages accept

struct CommandDatasetOptions {
  std::string run;
  std::string version;
  std::string sequence;
  UsedTrajectory use = UsedTrajectory::open;
  bool shell = false;
  std::string depends;
  bool network = false;
  double seconds = 0.0;
  double memory = 0.0;
  InformationRules rules;
  TrajectoryOptions trajectory;  ///< the files of the program are set by the loader
};

/// Options of `trajectory` that the program's files determine.
inline constexpr std::array<std::string_view, 7> kProgramFiles{
    "estimate", "frames", "format", "times", "period", "closures.source", "closures.file"};

template <class Visit>
void fields(CommandDatasetOptions& o, Visit visit) {
  visit("run",
        o.run,
        "program and arguments; {sequence}: input, {trajectory}: file to write, {seed}: another "
        "number below 2^31 for each repeat");
  visit("version", o.version, "version of the program, free text; another one runs it again");
  visit("sequence", o.sequence, "input of the program: a folder or a file; empty: none");
  visit("use", o.use, "trajectory to correct or evaluate; closed: after the program's own closing");
  visit("shell", o.shell, "whether sh interprets the text of run");
  visit("depends", o.depends, "files whose change runs the program again, separated by blanks");
  visit("network", o.network, "whether the program can use the network");
  visit("seconds", o.seconds, "time limit of the program [s]; 0: that of cells", Between{0.0});
  visit(
      "memory", o.memory, "memory limit of the program [MiB]; 0: that of cells", Between{0.0, 1e9});
  information_fields(o.rules, visit);
  fields(o.trajectory, [&](const char* name, auto& member, const char* help, const auto&... rule) {
    if (std::ranges::count(kProgramFiles, name) == 0) visit(name, member, help, rule...);
  });
}

/// The sequence's folder or file in the search folders.
std::filesystem::path found_sequence(const std::string& sequence, const DataRoot& root) {
  if (sequence.empty()) return {};
  for (const std::filesystem::path& folder : root.folders) {
    if (std::filesystem::is_directory(folder / sequence))
      return std::filesystem::absolute(folder / sequence);
  }
  return std::filesystem::absolute(root.find(sequence));
}

/// All regular files of the sequence, sorted.
std::set<std::filesystem::path> files_of_sequence(const std::filesystem::path& sequence) {
  std::set<std::filesystem::path> out;
  if (std::filesystem::is_regular_file(sequence)) out.insert(sequence);
  if (!std::filesystem::is_directory(sequence)) return out;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(sequence)) {
    if (entry.is_regular_file()) out.insert(entry.path());
  }
  return out;
}

/// Files that the command line and `depends` name.
std::set<std::filesystem::path> program_files(const CommandDatasetOptions& o,
                                              const std::filesystem::path& folder) {
  std::set<std::filesystem::path> out;
  for (const std::string& name : named_files(o.run, o.depends, folder)) out.insert(folder / name);
  return out;
}

/// With what determines which files the program could read.
std::string output_key(const CommandDatasetOptions& o,
                       const std::set<std::filesystem::path>& program,
                       const std::filesystem::path& sequence,
                       const DataRoot& root) {
  Fields out;
  out.add("command dataset 4").add(o.run).add(o.shell ? "sh" : "").add(o.version);
  out.add(std::to_string(o.trajectory.seed));
  for (const auto& file : program) out.add(hex(hash_of_file(file)));
  out.add("sequence");
  for (const auto& file : files_of_sequence(sequence)) {
    out.add(file.lexically_relative(sequence).string()).add(hex(hash_of_file(file)));
  }
  out.add(is_sandboxed() ? "sandbox" : "no sandbox");
  out.add(o.network || !can_hide_network() ? "network" : "");
  for (const auto& folder : root.folders) out.add(std::filesystem::absolute(folder).string());
  out.add(o.trajectory.reference);
  return out.hashed();
}

/// Restrictions of the program: it sees its sequence, but not the reference.
SandboxOptions sandbox_of_sequence(const CommandDatasetOptions& o,
                                   const DataRoot& root,
                                   const std::filesystem::path& sequence) {
  SandboxOptions options = program_sandbox();
  if (!o.trajectory.reference.empty()) {
    const std::filesystem::path reference = root.find(o.trajectory.reference);
    std::error_code none;
    if (!std::filesystem::equivalent(reference, sequence, none)) {
      options.hidden.push_back(reference);
    }
  }
  return options;
}

ProgramCost run_program(const CommandDatasetOptions& o,
                        const DataRoot& root,
                        const std::filesystem::path& folder,
                        const std::filesystem::path& sequence,
                        const std::filesystem::path& trajectory) {
  const SandboxOptions sandbox = sandbox_of_sequence(o, root, sequence);
  ProgramStart start = start_on({{"sequence", sequence}, {"trajectory", trajectory}},
                                trajectory.parent_path(),
                                o.run,
                                o.shell,
                                {{"seed", std::to_string(o.trajectory.seed & kMostSeed)}});
  start.folder = folder;
  start.sandbox = &sandbox;
  start.network = o.network;
  if (!sequence.empty()) start.readable.push_back(sequence);
  std::string output;
  // Without arguments in braces: their paths would fill the line.
  RunningLine line(o.run.substr(0, o.run.find(" {")));
  const auto begin = std::chrono::steady_clock::now();
  const ProgramEnd end =
      RunningProgram(start).wait(output, [&](const std::string& printed) { line.draw(printed); });
  if (end.exit_code != 0) {
    throw InputError(
        with_output("run: " + o.run + ": the program " + text(end) + hidden_note(sandbox), output));
  }
  if (!is_own_file(trajectory)) {
    throw InputError(with_output("run: " + o.run + ": the program wrote no trajectory", output));
  }
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  return {time.count(), end.peak_memory};
}

/// Throws InputError if a run that was kept took more than the dataset states.
void require_limits(const CommandDatasetOptions& o, const ProgramCost& cost) {
  if (o.seconds > 0.0 && cost.seconds > o.seconds) {
    throw InputError(fmt::format(
        "run: {}: the program took {:.1f} s, the limit is {:g} s", o.run, cost.seconds, o.seconds));
  }
  const double memory = static_cast<double>(cost.peak_memory) / kMebibyte;
  if (o.memory > 0.0 && memory > o.memory) {
    throw InputError(fmt::format(
        "run: {}: the program used {:.0f} MiB, the limit is {:g} MiB", o.run, memory, o.memory));
  }
}

/// "the program took 42.1 s (real-time factor 0.35), 812 MiB"
std::string cost_note(const ProgramCost& cost, const Trajectory& estimate) {
  const double duration =
      estimate.size() < 2 ? 0.0 : estimate.back().stamp - estimate.front().stamp;
  const std::string share = duration > 0.0
                                ? fmt::format(" (real-time factor {:.3g})", cost.seconds / duration)
                                : std::string();
  return fmt::format("the program took {:.3g} s{}, {:.0f} MiB",
                     cost.seconds,
                     share,
                     static_cast<double>(cost.peak_memory) / kMebibyte);
}

/// Throws OptionError without a program, or if run does not name {trajectory}.
void check_combination(const CommandDatasetOptions& o) {
  command_words("run", o.run, false);
  if (o.run.find("{trajectory}") == std::string::npos) {
    throw OptionError("run", "run: does not contain {trajectory}: " + o.run);
  }
  if (o.run.find("{sequence}") != std::string::npos && o.sequence.empty()) {
    throw OptionError("sequence", "sequence: is empty, but run contains {sequence}");
  }
}

/// Whether a file of g2o has edges, which follow the vertices; without reading all of it.
bool has_edges(const std::filesystem::path& file) {
  if (detect_format(file) != Format::g2o) return false;
  std::ifstream in(file);
  std::string word;
  for (std::string rest; in >> word && !word.starts_with("EDGE"); std::getline(in, rest)) {
  }
  return word.starts_with("EDGE");
}

/// A pose graph that the program wrote: its edges are the problem.
PoseGraphOptions graph_options(const CommandDatasetOptions& o, const std::string& file) {
  PoseGraphOptions out;
  out.name = o.trajectory.name.empty() ? o.run : o.trajectory.name;
  out.path = file;
  out.truth = o.trajectory.reference;
  out.reference_body = o.trajectory.reference_body;
  out.rules = o.rules;
  out.false_closures = o.trajectory.false_closures;
  out.sensor = o.trajectory.sensor;
  out.licence = o.trajectory.licence;
  return out;
}

/// Runs the program in the first folder of `root`, the config's, unless `cache` has its output for
/// the same command, program files, sequence content and seed. Throws InputError with the end of
/// the program's output if it fails.
Sequence load_command(const CommandDatasetOptions& o,
                      const DataRoot& root,
                      const std::filesystem::path& cache) {
  check_combination(o);
  const std::filesystem::path folder = root.folders.empty() ? "." : root.folders.front();
  const std::filesystem::path sequence = found_sequence(o.sequence, root);
  const auto program = program_files(o, folder);
  const std::filesystem::path kept =
      cache.empty() ? std::filesystem::temp_directory_path() / "loopbench-programs"
                    : cache / "programs";
  const ProgramOutput out =
      kept_output(kept, output_key(o, program, sequence, root), [&](const auto& to) {
        return run_program(o, root, folder, sequence, to);
      });
  require_limits(o, out.cost);

  TrajectoryOptions options = o.trajectory;
  const std::string open = std::filesystem::absolute(out.trajectory).string();
  const bool is_closed = o.use == UsedTrajectory::closed;
  options.estimate = is_closed ? open + ".closed" : open;
  if (is_closed && !std::filesystem::exists(options.estimate)) {
    throw InputError("run: " + o.run + ": the program wrote no {trajectory}.closed");
  }
  if (!is_closed && std::filesystem::exists(open + ".frames")) options.frames = open + ".frames";
  if (!is_closed && std::filesystem::exists(open + ".loops")) {
    options.closures = ClosureSource::file;
    options.closures_file = open + ".loops";
  }
  if (options.name.empty()) options.name = o.run;
  const bool is_graph = !is_closed && has_edges(open);
  Sequence loaded =
      is_graph ? load_pose_graph(graph_options(o, open), root) : load_trajectory(options, root);
  loaded.provenance.notes.push_back(cost_note(out.cost, loaded.problem.keyframes));
  loaded.provenance.closures = is_closed ? "none: closed by the program" : "of the program";
  for (const auto& files : {program, files_of_sequence(sequence)}) {
    for (const auto& file : files) loaded.provenance.inputs.push_back({file, ""});
  }
  return loaded;
}

}  // namespace

Limits loading_limits(const Choice& dataset, Limits of_cells) {
  if (dataset.name != kCommand) return of_cells;
  const auto options = with(CommandDatasetOptions{}, dataset.options);
  if (options.seconds > 0.0) of_cells.seconds = options.seconds;
  if (options.memory > 0.0) of_cells.memory = static_cast<std::int64_t>(options.memory * kMebibyte);
  return of_cells;
}

DatasetEntry command_dataset(const std::filesystem::path& cache) {
  return dataset<CommandDatasetOptions>(
      kCommand,
      "any program as a SLAM system; see methods/bring_a_method.md",
      [cache](const CommandDatasetOptions& options, const DataRoot& root) {
        return load_command(options, root, cache);
      });
}

Limits longest_limits(const Sweep& sweep) {
  Limits out = sweep.limits;
  if (out.seconds <= 0.0) return out;
  for (const DatasetChoice& choice : sweep.datasets) {
    out.seconds = std::max(out.seconds, loading_limits(choice.dataset, sweep.limits).seconds);
  }
  return out;
}

}  // namespace loopbench::harness
