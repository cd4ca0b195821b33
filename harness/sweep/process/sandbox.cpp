#include "harness/sweep/process/sandbox.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iterator>
#include <map>
#include <sstream>
#include <system_error>

#include "harness/sweep/process/bubblewrap.hpp"
#include "harness/sweep/process/mounts.hpp"
#include "harness/sweep/process/system_file.hpp"

namespace loopbench::harness {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTemporary = "/tmp";

/// Other folders in which processes leave files or answer; some may not exist.
constexpr std::array<const char*, 4> kMeetingPlaces{
    "/var/tmp", "/run/user", "/run/dbus", "/run/lock"};

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

enum class View { hidden_file, hidden_folder, own_temporary, readable, writable };
using Views = std::map<fs::path, View>;  // a folder precedes what is in it

/// Folders of packages in folders for temporary files, which a program needs: those in the
/// variables by which interpreters find them, and the home folder.
std::vector<fs::path> needed_in(const fs::path& temporary) {
  std::vector<fs::path> out;
  for (const char* const variable : {"PATH", "PYTHONPATH", "LD_LIBRARY_PATH", "HOME"}) {
    const char* const value = std::getenv(variable);
    std::istringstream folders(value == nullptr ? "" : value);
    for (std::string each; std::getline(folders, each, ':');) {
      if (!each.starts_with('/')) continue;
      fs::path folder = resolved(each);
      if (folder.filename() == "bin") folder = folder.parent_path();  // with lib beside it
      std::error_code error;
      const bool is_inside = folder != temporary && contains(temporary, folder);
      if (is_inside && fs::is_directory(folder, error)) out.push_back(folder);
    }
  }
  return out;
}

/// Hides the services of the system, some of which read files for others.
void hide_sockets(Views& views, const fs::path& folder) {
  constexpr int kDeepest = 2;
  constexpr std::size_t kMost = 2000;  // entries
  std::error_code error;
  const auto options = fs::directory_options::skip_permission_denied;
  fs::recursive_directory_iterator entry(folder, options, error);
  for (std::size_t seen = 0; entry != fs::recursive_directory_iterator() && !error; ++seen) {
    if (seen == kMost) break;
    if (entry.depth() >= kDeepest) entry.disable_recursion_pending();
    if (entry->is_socket(error)) views.try_emplace(entry->path(), View::hidden_file);
    entry.increment(error);
  }
}

/// Hides what others leave in folders for temporary files.
void hide_temporary(Views& views, const fs::path& writable) {
  const View view = writable.empty() ? View::hidden_folder : View::own_temporary;
  views[resolved(kTemporary)] = view;
  for (const char* const place : kMeetingPlaces) {
    std::error_code error;
    if (fs::is_directory(place, error)) views.try_emplace(resolved(place), View::hidden_folder);
  }
  hide_sockets(views, "/run");
  for (const fs::path& each : needed_in(resolved(kTemporary))) views[each] = View::readable;
}

bool is_of_sweep(const fs::path& entry) {
  const std::string name = entry.filename().string();
  return std::ranges::any_of(
      std::array{
          "loopbench-sweep-", "loopbench-exchange-", "loopbench-serve-", "loopbench-programs"},
      [&](const char* prefix) { return name.starts_with(prefix); });
}

/// Shows a folder of the program. If it is one for temporary files, without the folders of sweeps.
void show(Views& views, const fs::path& folder, const fs::path& writable) {
  std::error_code error;
  if (views.contains(folder) && views[folder] == View::own_temporary) {
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      if (!is_of_sweep(entry.path())) views.try_emplace(entry.path(), View::readable);
    }
    return;
  }
  views[folder] = View::readable;
  if (writable.empty() || !contains(folder, writable)) return;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const bool is_hidden = is_of_sweep(entry.path()) && entry.is_directory(error);
    if (is_hidden) views.try_emplace(entry.path(), View::hidden_folder);
  }
}

/// Hides an existing path; of a file, its folder, too, unless programs need that.
void hide(Views& views, const fs::path& path) {
  std::error_code error;
  const bool is_folder = fs::is_directory(path, error);
  if (!is_folder && !fs::exists(path, error)) return;
  const fs::path folder = is_folder ? path : path.parent_path();
  const bool is_empty = views.contains(folder) && views[folder] == View::own_temporary;
  if (!is_needed(folder) && !is_empty) views[folder] = View::hidden_folder;
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
  const auto is_hidden_file = [&](const fs::path& file) {
    const auto found = hidden.find(file);
    return found != hidden.end() && found->second == View::hidden_file;
  };
  const fs::path writable = program.writable.empty() ? "" : resolved(program.writable);
  show(views, resolved(program.folder), writable);
  bool is_program = true;  // the first file that is not of the system
  for (const fs::path& name : program_files(program)) {
    std::error_code error;
    const fs::path file = resolved(program.folder / name);
    if (fs::is_directory(file, error)) continue;
    if (!fs::is_regular_file(file, error) || is_hidden_file(file)) continue;
    const fs::path folder = file.parent_path();
    if (is_program || !hidden.contains(folder)) show(views, folder, writable);
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

bool is_empty(View view) { return view == View::hidden_folder || view == View::own_temporary; }

void append(std::vector<std::string>& out, const Views& views, const fs::path& own_temporary) {
  for (const auto& [path, view] : views) {
    switch (view) {
      case View::hidden_folder:
        out.insert(out.end(), {"--tmpfs", path.string()});
        break;
      case View::hidden_file:
        if (is_empty(view_of_folder(views, path))) break;
        out.insert(out.end(), {"--ro-bind", "/dev/null", path.string()});
        break;
      case View::own_temporary:
        out.insert(out.end(), {"--bind", own_temporary.string(), path.string()});
        break;
      case View::readable:
        out.insert(out.end(), {"--ro-bind-try", path.string(), path.string()});
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

std::string missing_protection(const SandboxOptions& options) {
  if (!options.enabled || can_hide_network()) return "";
  if (has_bubblewrap())
    return "bubblewrap (bwrap) cannot hide the network here: programs can use it";
  return "bubblewrap (bwrap) does not work here: programs can read all files, among them "
         "references, "
         "stores and files of other cells, and use the network";
}

std::vector<std::string> sandboxed_arguments(const SandboxOptions& options,
                                             const SandboxedProgram& program) {
  Views views;
  hide_temporary(views, program.writable);
  const std::vector<Mount> mounts = mounts_in(read_system_file("/proc/self/mountinfo"));
  for (const fs::path& path : options.hidden) {
    const fs::path name = resolved(path);
    hide(views, name);
    for (const fs::path& other : other_names(name, mounts)) hide(views, other);
  }
  show_own_folders(views, program);
  for (const fs::path& path : program.readable) views[resolved(path)] = View::readable;
  fs::path own_temporary;
  if (!program.writable.empty()) {
    own_temporary = resolved(program.writable) / ".tmp";
    fs::create_directories(own_temporary);
    views[resolved(program.writable)] = View::writable;
  }
  std::vector<std::string> out = bubblewrap_arguments(program.network || !can_hide_network());
  append(out, views, own_temporary);
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
  constexpr std::size_t kMost = 6;
  if (!options.enabled || !has_bubblewrap()) return "";
  std::vector<std::string> names;
  for (const fs::path& path : options.hidden) {
    std::error_code error;
    const std::string name = path.lexically_normal().string();
    if (fs::exists(path, error) && std::ranges::count(names, name) == 0) names.push_back(name);
  }
  std::string out;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i) {
    out += (out.empty() ? "; the sandbox hides " : ", ") + names[i];
  }
  if (names.size() > kMost) out += " and " + std::to_string(names.size() - kMost) + " more";
  return out.empty() ? out : out + " from it";
}

}  // namespace loopbench::harness
