#include <fmt/format.h>

#include "datasets/core/error.hpp"
#include "harness/external/arguments.hpp"
#include "harness/external/command.hpp"
#include "harness/process/program.hpp"
#include "harness/text/hash.hpp"

namespace loopbench::harness {
namespace {

std::filesystem::path in_folder(const CommandSetting& setting, const std::string& name) {
  return setting.folder / name;  // an absolute name stays absolute
}

}  // namespace

std::string command_version(const CommandOptions& options, const CommandSetting& setting) {
  Fields fields;
  const auto add = [&](const std::string& name) {
    fields.add(name).add(hex(hash_of_file(in_folder(setting, name))));
  };
  for (const std::string& word :
       split_arguments("run", options.run.empty() ? options.serve : options.run)) {
    std::error_code none;
    if (std::filesystem::is_regular_file(in_folder(setting, word), none)) add(word);
  }
  if (!options.depends.empty()) {
    for (const std::string& name : split_arguments("depends", options.depends)) {
      if (!std::filesystem::is_regular_file(in_folder(setting, name))) {
        throw InputError("depends: " + in_folder(setting, name).string() + ": is not a file");
      }
      add(name);
    }
  }
  if (options.version.empty()) return fields.hashed();
  ProgramStart start;
  start.arguments = split_arguments("version", options.version);
  start.folder = setting.folder;
  std::string output;
  const ProgramEnd end = RunningProgram(start).wait(output);
  if (end.exit_code != 0) {
    throw InputError(with_output("version: " + options.version + ": " + text(end), output));
  }
  return fields.add(output).hashed();
}

}  // namespace loopbench::harness
