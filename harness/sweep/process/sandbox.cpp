#include "harness/sweep/process/sandbox.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <map>
#include <sstream>
#include <system_error>

#include "harness/sweep/process/child_process.hpp"

namespace loopbench::harness {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> base_arguments() {
  std::istringstream words(
      "bwrap --die-with-parent --new-session --unshare-pid --unshare-ipc --cap-drop ALL "
      "--ro-bind / / --dev-bind /dev /dev "
      "--tmpfs /dev/shm --proc /proc");
  return {std::istream_iterator<std::string>(words), {}};
}

bool run_bubblewrap() {
  ProgramCall call;
  call.arguments = base_arguments();
  call.arguments.insert(call.arguments.end(), {"--", "true"});
  const int null = open("/dev/null", O_WRONLY | O_CLOEXEC);
  call.output = call.errors = null;
  bool out = false;
  try {
    out = ChildProcess(ProcessGroup::own, call).exit_code() == 0;
  } catch (const std::runtime_error&) {  // it is not installed
  }
  close(null);
  return out;
}

fs::path resolved(const fs::path& path) {
  std::error_code error;
  const fs::path out = fs::weakly_canonical(fs::absolute(path, error), error);
  return out.has_filename() ? out : out.parent_path();
}

bool contains(const fs::path& folder, const fs::path& path) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

/// Programs need the system's folders, and interpreters their packages in the user's home.
bool is_needed(const fs::path& folder) {
  std::vector<fs::path> needed{"/usr", "/etc", "/bin", "/lib", "/proc", "/dev"};
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/') {
    needed.push_back(resolved(home));
  }
  return contains("/usr", folder) || contains("/etc", folder) ||
         std::ranges::any_of(needed, [&](const fs::path& each) { return contains(folder, each); });
}

enum class View { hidden_file, hidden_folder, readable, writable };
using Views = std::map<fs::path, View>;  // a folder precedes what is in it

/// Hides an existing path; of a file, its folder, too, unless programs need that.
void hide(Views& views, const fs::path& path) {
  std::error_code error;
  const bool is_folder = fs::is_directory(path, error);
  if (!is_folder && !fs::exists(path, error)) return;
  const fs::path folder = is_folder ? path : path.parent_path();
  if (!is_needed(folder)) views[folder] = View::hidden_folder;
  if (!is_folder) views[path] = View::hidden_file;
}

/// Names of files in a command line: its words, and the words of a line for a shell.
std::vector<fs::path> program_files(const SandboxedProgram& program) {
  std::vector<fs::path> out;
  for (const std::string& argument : program.arguments) {
    std::istringstream words(argument);
    out.emplace_back(argument);
    for (std::string word; words >> word;) out.emplace_back(word);
  }
  return out;
}

void show_own_folders(Views& views, const SandboxedProgram& program) {
  const Views hidden = views;
  views[resolved(program.folder)] = View::readable;
  bool is_program = true;  // the first file that is not of the system
  for (const fs::path& name : program_files(program)) {
    std::error_code error;
    const fs::path file = resolved(program.folder / name);
    if (fs::is_directory(file, error)) continue;
    if (!fs::is_regular_file(file, error)) continue;
    const fs::path folder = file.parent_path();
    if (is_program || !hidden.contains(folder)) views[folder] = View::readable;
    views[file] = View::readable;
    if (!is_needed(folder)) is_program = false;
  }
}

/// The view of the closest folder in the list that contains the path.
View view_of_folder(const Views& views, const fs::path& path) {
  for (fs::path at = path.parent_path(); at != at.parent_path(); at = at.parent_path()) {
    if (const auto found = views.find(at); found != views.end()) return found->second;
  }
  return View::readable;
}

void append(std::vector<std::string>& out, const Views& views) {
  for (const auto& [path, view] : views) {
    switch (view) {
      case View::hidden_folder:
        out.insert(out.end(), {"--tmpfs", path.string()});
        break;
      case View::hidden_file:
        if (view_of_folder(views, path) == View::hidden_folder) break;
        out.insert(out.end(), {"--ro-bind", "/dev/null", path.string()});
        break;
      case View::readable:
        out.insert(out.end(), {"--ro-bind", path.string(), path.string()});
        break;
      case View::writable:
        out.insert(out.end(), {"--bind", path.string(), path.string()});
        break;
    }
  }
  // After what is mounted in them; otherwise they would be memory that a program can fill.
  for (const auto& [path, view] : views) {
    if (view == View::hidden_folder) out.insert(out.end(), {"--remount-ro", path.string()});
  }
}

}  // namespace

bool has_bubblewrap() {
  static const bool out = run_bubblewrap();
  return out;
}

std::vector<std::string> sandboxed_arguments(const SandboxOptions& options,
                                             const SandboxedProgram& program) {
  Views views;
  for (const fs::path& path : options.hidden) hide(views, resolved(path));
  show_own_folders(views, program);
  for (const fs::path& path : program.readable) views[resolved(path)] = View::readable;
  if (!program.writable.empty()) views[resolved(program.writable)] = View::writable;
  std::vector<std::string> out = base_arguments();
  append(out, views);
  out.insert(out.end(), {"--chdir", resolved(program.folder).string(), "--"});
  out.insert(out.end(), program.arguments.begin(), program.arguments.end());
  return out;
}

SandboxOptions& program_sandbox() {
  static SandboxOptions options;
  return options;
}

bool is_sandboxed() { return program_sandbox().enabled && has_bubblewrap(); }

std::string hidden_note(const SandboxOptions& options) {
  std::string out;
  if (!options.enabled || !has_bubblewrap()) return out;
  for (const fs::path& path : options.hidden) {
    std::error_code error;
    if (!fs::exists(path, error)) continue;
    out += (out.empty() ? "; the sandbox hides " : ", ") + path.string();
  }
  return out.empty() ? out : out + " from it";
}

}  // namespace loopbench::harness
