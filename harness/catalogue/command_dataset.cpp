#include "harness/catalogue/command_dataset.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <set>
#include <string_view>

#include "datasets/trajectory_dataset.hpp"
#include "harness/base/file_lock.hpp"
#include "harness/base/hash.hpp"
#include "harness/base/program.hpp"
#include "harness/base/write_file.hpp"
#include "harness/catalogue/arguments.hpp"
#include "harness/catalogue/command.hpp"
#include "harness/catalogue/loading.hpp"
#include "harness/catalogue/scratch.hpp"

namespace loopbench::harness {
namespace {

enum class UsedTrajectory { open, closed };
inline auto choices(UsedTrajectory) {
  return std::array{std::pair{"open", UsedTrajectory::open},
                    std::pair{"closed", UsedTrajectory::closed}};
}

struct CommandDatasetOptions {
  std::string run;
  std::string sequence;
  UsedTrajectory use = UsedTrajectory::open;
  bool shell = false;
  std::string depends;
  double seconds = 0.0;
  double memory = 0.0;
  TrajectoryOptions trajectory;  ///< the files of the program are set by the loader
};

/// Options of `trajectory` that the program's files determine.
inline constexpr std::array<std::string_view, 7> kProgramFiles{
    "estimate", "frames", "format", "times", "period", "closures.source", "closures.file"};

template <class Visit>
void fields(CommandDatasetOptions& o, Visit visit) {
  visit("run",
        o.run,
        "program and arguments; {sequence}: input, {trajectory}: file to write, {seed}: repeat");
  visit("sequence", o.sequence, "input of the program: a folder or a file; empty: none");
  visit("use", o.use, "trajectory to correct or evaluate; closed: after the program's own closing");
  visit("shell", o.shell, "whether sh interprets the text of run");
  visit("depends", o.depends, "files whose change runs the program again, separated by blanks");
  visit("seconds", o.seconds, "time limit of the program [s]; 0: that of cells", Between{0.0});
  visit(
      "memory", o.memory, "memory limit of the program [MiB]; 0: that of cells", Between{0.0, 1e9});
  fields(o.trajectory, [&](const char* name, auto& member, const char* help, const auto&... rule) {
    if (std::ranges::count(kProgramFiles, name) == 0) visit(name, member, help, rule...);
  });
}

constexpr const char* kOpen = "open.txt";
constexpr const char* kHashes = "hashes";  // of the output, as it was written

/// "NAME HASH" lines of the program's output in a folder.
std::string output_hashes(const std::filesystem::path& folder) {
  std::string out;
  for (const char* suffix : {"", ".frames", ".loops", ".closed"}) {
    const std::filesystem::path file = folder / (std::string(kOpen) + suffix);
    if (std::filesystem::is_regular_file(file)) {
      out += file.filename().string() + " " + hex(hash_of_file(file)) + "\n";
    }
  }
  return out;
}

/// Whether the folder has what the program wrote, neither incomplete nor changed since.
bool is_whole(const std::filesystem::path& folder) {
  std::ifstream in(folder / kHashes, std::ios::binary);
  const std::string stored{std::istreambuf_iterator<char>(in), {}};
  return !stored.empty() && stored == output_hashes(folder);
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

std::string output_key(const CommandDatasetOptions& o,
                       const std::set<std::filesystem::path>& program,
                       const std::set<std::filesystem::path>& sequence) {
  Fields out;
  out.add("command dataset 1").add(o.run).add(o.shell ? "sh" : "");
  out.add(std::to_string(o.trajectory.seed));
  for (const auto& file : program) out.add(hex(hash_of_file(file)));
  out.add("sequence");
  for (const auto& file : sequence) out.add(file.filename().string()).add(hex(hash_of_file(file)));
  return out.hashed();
}

/// A regular file, not a link to one.
bool is_own_file(const std::filesystem::path& file) {
  std::error_code none;
  return std::filesystem::is_regular_file(std::filesystem::symlink_status(file, none));
}

/// Restrictions of the program: it sees its sequence, but not the reference.
SandboxOptions sandbox_of(const CommandDatasetOptions& o,
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

void run_program(const CommandDatasetOptions& o,
                 const DataRoot& root,
                 const std::filesystem::path& folder,
                 const std::filesystem::path& sequence,
                 const std::filesystem::path& trajectory) {
  const SandboxOptions sandbox = sandbox_of(o, root, sequence);
  ProgramStart start;
  start.folder = folder;
  start.sandbox = &sandbox;
  start.writable = trajectory.parent_path();
  if (!sequence.empty()) start.readable.push_back(sequence);
  start.environment = {{"LOOPBENCH_SEQUENCE", sequence.string()},
                       {"LOOPBENCH_TRAJECTORY", trajectory.string()},
                       {"TMPDIR", trajectory.parent_path().string()}};
  start.arguments =
      with_values(command_words("run", o.run, o.shell),
                  {{"sequence", o.shell ? "${LOOPBENCH_SEQUENCE}" : sequence.string()},
                   {"trajectory", o.shell ? "${LOOPBENCH_TRAJECTORY}" : trajectory.string()},
                   {"seed", std::to_string(o.trajectory.seed)}});
  std::string output;
  RunningLine line(o.run);
  const ProgramEnd end =
      RunningProgram(start).wait(output, [&](const std::string& printed) { line.draw(printed); });
  if (end.exit_code != 0) {
    throw InputError(
        with_output("run: " + o.run + ": the program " + text(end) + hidden_note(sandbox), output));
  }
  if (!is_own_file(trajectory)) {
    throw InputError(with_output("run: " + o.run + ": the program wrote no trajectory", output));
  }
}

/// Folder with the program's output, from the cache or new.
std::filesystem::path program_output(const CommandDatasetOptions& o,
                                     const DataRoot& root,
                                     const std::filesystem::path& folder,
                                     const std::filesystem::path& sequence,
                                     const std::filesystem::path& cache,
                                     const std::string& key) {
  const std::filesystem::path all =
      cache.empty() ? std::filesystem::temp_directory_path() / "loopbench-programs"
                    : cache / "programs";
  const std::filesystem::path out = all / key;
  if (is_whole(out)) return out;
  std::filesystem::create_directories(all);
  const FileLock lock(all / (key + ".lock"));  // a worker that needs the same run waits for it
  if (is_whole(out)) return out;
  const ExchangeFolder work;
  run_program(o, root, folder, sequence, work.path() / kOpen);
  std::string part = (all / (key + "-XXXXXX")).string();
  if (mkdtemp(part.data()) == nullptr) throw InputError(part + ": cannot be created");
  try {
    for (const char* suffix : {"", ".frames", ".loops", ".closed"}) {
      const std::string name = std::string(kOpen) + suffix;
      if (is_own_file(work.path() / name)) {
        std::filesystem::copy_file(work.path() / name, std::filesystem::path(part) / name);
      }
    }
    write_file(std::filesystem::path(part) / kHashes, output_hashes(part));
    std::filesystem::remove_all(out);  // an incomplete or changed one
    std::filesystem::rename(part, out);
  } catch (...) {
    std::filesystem::remove_all(part);
    throw;
  }
  return out;
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
  const auto recording = files_of_sequence(sequence);
  const std::filesystem::path out =
      program_output(o, root, folder, sequence, cache, output_key(o, program, recording));

  TrajectoryOptions options = o.trajectory;
  const std::string open = std::filesystem::absolute(out / kOpen).string();
  const auto exists = [](const std::string& file) { return std::filesystem::exists(file); };
  const bool is_closed = o.use == UsedTrajectory::closed;
  options.estimate = is_closed ? open + ".closed" : open;
  if (is_closed && !exists(options.estimate)) {
    throw InputError("run: " + o.run + ": the program wrote no {trajectory}.closed");
  }
  if (!is_closed && exists(open + ".frames")) options.frames = open + ".frames";
  if (!is_closed && exists(open + ".loops")) {
    options.closures = ClosureSource::file;
    options.closures_file = open + ".loops";
  }
  if (options.name.empty()) options.name = o.run;
  Sequence loaded = load_trajectory(options, root);
  loaded.provenance.closures = is_closed ? "none: closed by the program" : "of the program";
  for (const auto& files : {program, recording}) {
    for (const auto& file : files) loaded.provenance.inputs.push_back({file, ""});
  }
  return loaded;
}

}  // namespace

Limits loading_limits(const Choice& dataset, Limits of_cells) {
  if (dataset.name != kCommandDataset) return of_cells;
  const auto options = with(CommandDatasetOptions{}, dataset.options);
  constexpr double kMebibyte = 1 << 20;
  if (options.seconds > 0.0) of_cells.seconds = options.seconds;
  if (options.memory > 0.0) {
    of_cells.memory = static_cast<std::int64_t>(options.memory * kMebibyte);
  }
  return of_cells;
}

DatasetEntry command_dataset(const std::filesystem::path& cache) {
  return dataset<CommandDatasetOptions>(
      kCommandDataset,
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
