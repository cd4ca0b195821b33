#include "harness/external/command_dataset.hpp"

#include <unistd.h>

#include <set>

#include "harness/external/arguments.hpp"
#include "harness/external/command.hpp"
#include "harness/external/external_datasets.hpp"
#include "harness/external/process_tree.hpp"
#include "harness/text/hash.hpp"

namespace loopbench::harness {
namespace {

constexpr const char* kOpen = "open.txt";

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
  for (const std::string& word : split_arguments("run", o.run)) {
    if (std::filesystem::is_regular_file(folder / word)) out.insert(folder / word);
  }
  if (o.depends.empty()) return out;
  for (const std::string& name : split_arguments("depends", o.depends)) {
    if (!std::filesystem::is_regular_file(folder / name)) {
      throw InputError("depends: " + (folder / name).string() + ": is not a file");
    }
    out.insert(folder / name);
  }
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

void run_program(const CommandDatasetOptions& o,
                 const std::filesystem::path& folder,
                 const std::filesystem::path& sequence,
                 const std::filesystem::path& trajectory) {
  ProgramStart start;
  start.folder = folder;
  start.environment = {{"LOOPBENCH_SEQUENCE", sequence.string()},
                       {"LOOPBENCH_TRAJECTORY", trajectory.string()}};
  start.arguments =
      with_values(command_words("run", o.run, o.shell),
                  {{"sequence", o.shell ? "${LOOPBENCH_SEQUENCE}" : sequence.string()},
                   {"trajectory", o.shell ? "${LOOPBENCH_TRAJECTORY}" : trajectory.string()},
                   {"seed", std::to_string(o.trajectory.seed)}});
  std::string output;
  const ProgramEnd end = ProcessTree(start).wait(output);
  if (end.exit_code != 0) {
    throw InputError(with_output("run: " + o.run + ": the program " + text(end), output));
  }
  if (!std::filesystem::is_regular_file(trajectory)) {
    throw InputError(with_output("run: " + o.run + ": the program wrote no trajectory", output));
  }
}

/// Folder with the program's output, from the cache or new.
std::filesystem::path program_output(const CommandDatasetOptions& o,
                                     const std::filesystem::path& folder,
                                     const std::filesystem::path& sequence,
                                     const std::filesystem::path& cache,
                                     const std::string& key) {
  const std::filesystem::path all =
      cache.empty() ? std::filesystem::temp_directory_path() / "loopbench-programs"
                    : cache / "programs";
  const std::filesystem::path out = all / key;
  if (std::filesystem::is_regular_file(out / kOpen)) return out;
  std::filesystem::create_directories(all);
  std::string part = (all / (key + "-XXXXXX")).string();
  if (mkdtemp(part.data()) == nullptr) throw InputError(part + ": cannot be created");
  try {
    run_program(o, folder, sequence, std::filesystem::path(part) / kOpen);
    std::error_code exists;  // another worker was faster: its output is as good
    std::filesystem::rename(part, out, exists);
    if (exists) std::filesystem::remove_all(part);
  } catch (...) {
    std::filesystem::remove_all(part);
    throw;
  }
  return out;
}

}  // namespace

void check_combination(const CommandDatasetOptions& o) {
  command_words("run", o.run, false);
  if (o.run.find("{trajectory}") == std::string::npos) {
    throw OptionError("run", "run: does not contain {trajectory}: " + o.run);
  }
  if (o.run.find("{sequence}") != std::string::npos && o.sequence.empty()) {
    throw OptionError("sequence", "sequence: is empty, but run contains {sequence}");
  }
}

Sequence load_command(const CommandDatasetOptions& o,
                      const DataRoot& root,
                      const std::filesystem::path& cache) {
  check_combination(o);
  const std::filesystem::path folder = root.folders.empty() ? "." : root.folders.front();
  const std::filesystem::path sequence = found_sequence(o.sequence, root);
  const auto program = program_files(o, folder);
  const auto recording = files_of_sequence(sequence);
  const std::filesystem::path out =
      program_output(o, folder, sequence, cache, output_key(o, program, recording));

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

std::vector<DatasetEntry> external_datasets(const std::filesystem::path& cache) {
  return {dataset<CommandDatasetOptions>(
      "command",
      "any program as a SLAM system; see methods/bring_a_method.md",
      [cache](const CommandDatasetOptions& options, const DataRoot& root) {
        return load_command(options, root, cache);
      })};
}

}  // namespace loopbench::harness
