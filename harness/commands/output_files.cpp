#include "harness/commands/output_files.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/core/error.hpp"
#include "harness/answers/report/draw.hpp"
#include "harness/sweep/process/write_file.hpp"

namespace loopbench::harness {
namespace {

namespace fs = std::filesystem;

/// How a command uses the files that an option names.
struct FileUse {
  const CLI::Option* option;
  std::optional<FileKind> kind = {};       ///< none: it only reads them
  const CLI::Option* only_with = nullptr;  ///< reads them without this option
};

struct DeclaredFiles {
  std::vector<FileUse> uses;
  bool force = false;
};

std::map<const CLI::App*, DeclaredFiles>& declared() {
  static std::map<const CLI::App*, DeclaredFiles> all;
  return all;
}

/// Of the command that runs; empty before one does.
struct CheckedFiles {
  std::vector<fs::path> inputs;
  std::vector<OutputFile> outputs;
  bool force = false;
};

CheckedFiles& checked() {
  static CheckedFiles files;
  return files;
}

std::vector<std::string> values_of(const CLI::Option& option) {
  if (option.count() > 0) return option.results();
  const std::string value = option.get_default_str();
  return value.empty() ? std::vector<std::string>{} : std::vector{value};
}

/// Files that a word can name: all of it, the store in a folder, that of a topic in a bag, or what
/// follows "=".
std::vector<fs::path> named_paths(const std::string& word) {
  std::vector<fs::path> out{word, fs::path(word) / "results.sqlite"};
  try {
    if (names_bag(word)) out.emplace_back(file_of(word));
  } catch (const InputError&) {  // reading reports it
  }
  if (const std::size_t end = word.find('='); end != word.npos)
    out.emplace_back(word.substr(end + 1));
  return out;
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

/// Whether two names are of one file, which need not exist.
bool are_same(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (is_file(a) && is_file(b)) return fs::equivalent(a, b, error) && !error;
  if (fs::exists(a, error) || fs::exists(b, error)) return false;
  const fs::path one = fs::weakly_canonical(fs::absolute(a, error), error);
  const fs::path other = fs::weakly_canonical(fs::absolute(b, error), error);
  return !one.empty() && one == other;  // empty: links in a circle, which writing reports
}

/// Whether it is a file of its own: no folder, and not what standard output is redirected to.
bool is_named(const OutputFile& output) {
  std::error_code error;
  if (output.replaces_links && fs::is_symlink(output.file, error)) return false;
  return output.file.has_filename() && !is_dash(output.file) &&
         !fs::is_directory(output.file, error) &&
         !fs::equivalent(output.file, "/proc/self/fd/1", error);
}

std::string listed(const std::vector<OutputFile>& files) {
  std::string out;
  for (const OutputFile& each : files) {
    out += (out.empty() ? "" : ", ") + each.file.string();
  }
  return out;
}

void reject_inputs(const std::vector<OutputFile>& outputs, const std::vector<fs::path>& inputs) {
  for (const OutputFile& output : outputs) {
    for (const fs::path& input : inputs) {
      if (!is_file(input) || !are_same(input, output.file)) continue;
      throw input_error(
          output.file.string(), 0, "is an input of this command and is not overwritten");
    }
  }
}

void reject_twice(const std::vector<OutputFile>& outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!are_same(outputs[i].file, outputs[j].file)) continue;
      throw input_error(outputs[i].file.string(),
                        0,
                        "is written by " + outputs[j].option + " and by " + outputs[i].option +
                            ", expected two names");
    }
  }
}

void reject_foreign(const std::vector<OutputFile>& outputs, bool force) {
  std::vector<OutputFile> foreign;
  for (const OutputFile& output : outputs) {
    if (is_file(output.file) && has_kind(output.file, output.kind)) continue;
    if (const std::string what = protected_content(output.file); !what.empty()) {
      throw input_error(
          output.file.string(),
          0,
          "is " + what + ", which " + output.option + " does not overwrite; expected another name");
    }
    if (!force && is_file(output.file)) foreign.push_back(output);
  }
  if (foreign.empty()) return;
  const bool is_one = foreign.size() == 1;
  throw InputError(listed(foreign) + (is_one ? ": exists and is not " : ": exist and are not ") +
                   (is_one ? noun_of(foreign.front().kind) : "what this command writes there") +
                   "; expected another " + foreign.front().option + ", or --force to overwrite " +
                   (is_one ? "it" : "them"));
}

void add_figure_files(std::vector<OutputFile>& out, const OutputFile& given, bool has_script) {
  OutputFile figure = given;
  figure.file = figure_name(given.file);
  out.push_back(figure);
  if (!has_script) return;
  for (const char* const ending : {"json", "py"}) {
    figure.file.replace_extension(ending);
    figure.kind = FileKind::drawing_script;
    out.push_back(figure);
  }
}

}  // namespace

CLI::Option* reads(CLI::App& command, CLI::Option* option) {
  declared()[&command].uses.push_back({option});
  return option;
}

void declare_force(CLI::App& command) {
  if (command.get_option_no_throw("--force") != nullptr) return;
  command.add_flag("--force",
                   declared()[&command].force,
                   "Overwrite files that are not of the kind that this command writes");
}

CLI::Option* writes(CLI::App& command, CLI::Option* option, FileKind kind) {
  declared()[&command].uses.push_back({option, kind});
  declare_force(command);
  return option;
}

CLI::Option* updates(CLI::App& command,
                     CLI::Option* option,
                     FileKind kind,
                     const CLI::Option* flag) {
  declared()[&command].uses.push_back({option, kind, flag});
  return option;
}

void remove_option(CLI::App& command, const std::string& name) {
  CLI::Option* const option = command.get_option(name);
  std::erase_if(declared()[&command].uses, [&](const FileUse& use) {
    return use.option == option || use.only_with == option;
  });
  command.remove_option(option);
}

void check_declared_files(const CLI::App& command) {
  checked() = {};
  const auto found = declared().find(&command);
  if (found == declared().end()) return;
  const auto is_given = [&](const CLI::Option* option) {
    return option != nullptr && option->count() > 0;
  };
  std::vector<OutputFile> outputs;
  for (const FileUse& use : found->second.uses) {
    const bool is_input = !use.kind || (use.only_with != nullptr && !is_given(use.only_with));
    for (const std::string& value : values_of(*use.option)) {
      if (is_input) {
        std::ranges::move(named_paths(value), std::back_inserter(checked().inputs));
        continue;
      }
      const OutputFile output{use.option->get_name(), value, *use.kind};
      if (output.kind == FileKind::figure && is_named(output)) {
        add_figure_files(outputs, output, is_given(command.get_option_no_throw("--script")));
      } else {
        outputs.push_back(output);
      }
    }
  }
  checked().force = found->second.force;
  require_writable(outputs);
}

void require_writable(const std::vector<OutputFile>& outputs) {
  std::vector<OutputFile> named;
  std::ranges::copy_if(outputs, std::back_inserter(named), is_named);
  std::vector<OutputFile> all = checked().outputs;
  all.insert(all.end(), named.begin(), named.end());
  reject_inputs(named, checked().inputs);
  reject_twice(all);
  reject_foreign(named, checked().force);
  checked().outputs = std::move(all);
}

}  // namespace loopbench::harness
