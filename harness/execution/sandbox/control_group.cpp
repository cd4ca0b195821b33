#include "harness/execution/sandbox/control_group.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <sstream>
#include <system_error>
#include <thread>

namespace loopbench::harness {
namespace {

using std::filesystem::path;

constexpr const char* kPrefix = "loopbench-";
constexpr const char* kMostTasks = "4096";  // processes and threads of a worker with its cell

std::string text_of_file(const path& file) {
  std::string out;
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return out;
  char buffer[4096];
  for (ssize_t size; (size = read(descriptor, buffer, sizeof buffer)) > 0;) {
    out.append(buffer, static_cast<std::size_t>(size));
  }
  close(descriptor);
  return out;
}

/// False if the system refuses, for example since the controller is not enabled.
bool write_setting(const path& file, const std::string& text) {
  const int descriptor = open(file.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool is_written = write(descriptor, text.data(), text.size()) >= 0;
  close(descriptor);
  return is_written;
}

bool contains_word(const std::string& text, const std::string& word) {
  std::istringstream in(text);
  for (std::string each; in >> each;) {
    if (each == word) return true;
  }
  return false;
}

/// Removes the groups in a folder and the folder; false if a process is left.
bool remove_groups(const path& folder) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (entry.is_directory(ignored)) rmdir(entry.path().c_str());
  }
  return rmdir(folder.c_str()) == 0;
}

/// Whether a process can move into the group.
bool can_be_entered(const ControlGroup& group) {
  const pid_t child = fork();
  if (child == 0) _exit(group.enter() ? 0 : 1);
  int status = 1;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// Descriptor of the folder of a sweep, locked, or -1 if another process uses it.
int lock_of(const path& folder) {
  const int out = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (out < 0 || flock(out, LOCK_EX | LOCK_NB) == 0) return out;
  close(out);
  return -1;
}

void remove_groups_of_killed_sweeps(const path& own) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(own, ignored)) {
    if (!entry.path().filename().string().starts_with(kPrefix)) continue;
    const int lock = lock_of(entry.path());
    if (lock < 0) continue;
    remove_groups(entry.path());
    close(lock);
  }
}

}  // namespace

path control_group_path(const std::string& cgroup, const std::string& mountinfo) {
  std::string own;
  std::istringstream groups(cgroup);
  for (std::string line; std::getline(groups, line);) {
    if (line.starts_with("0::/")) own = line.substr(3);
  }
  if (own.empty() || own.starts_with("/..")) return {};
  std::istringstream mounts(mountinfo);
  for (std::string line; std::getline(mounts, line);) {
    if (line.find(" - cgroup2 ") == std::string::npos) continue;
    std::istringstream fields(line);
    std::string skipped, root, point;
    fields >> skipped >> skipped >> skipped >> root >> point;
    if (root == "/") return point + own;
    if ((own + "/").starts_with(root + "/")) return point + own.substr(root.size());
  }
  return {};
}

ControlGroup::ControlGroup(const path& parent) {
  if (parent.empty()) return;
  std::string name = parent / "worker-XXXXXX";
  if (mkdtemp(name.data()) == nullptr) return;
  path_ = name;
  write_setting(path_ / "memory.swap.max", "0");
  write_setting(path_ / "pids.max", kMostTasks);
}

bool ControlGroup::enter() const {
  return !path_.empty() && write_setting(path_ / "cgroup.procs", "0");
}

void ControlGroup::limit_growth(std::int64_t growth) const {
  if (path_.empty()) return;
  const std::string now = text_of_file(path_ / "memory.current");
  if (now.empty()) return;
  write_setting(path_ / "memory.max", std::to_string(std::stoll(now) + growth));
}

void ControlGroup::remove_limit() const {
  if (!path_.empty()) write_setting(path_ / "memory.max", "max");
}

std::int64_t ControlGroup::ended_by_limit() const {
  if (path_.empty()) return 0;
  std::istringstream in(text_of_file(path_ / "memory.events"));
  std::string event;
  for (std::int64_t count = 0; in >> event >> count;) {
    if (event == "oom_kill") return count;
  }
  return 0;
}

void ControlGroup::kill() const {
  if (!path_.empty()) write_setting(path_ / "cgroup.kill", "1");
}

void ControlGroup::end() {
  if (path_.empty()) return;
  kill();
  // Killed processes need a moment to end. What remains is removed with the folder.
  for (int i = 0; rmdir(path_.c_str()) != 0 && errno == EBUSY && i < 200; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  path_.clear();
}

ControlGroups::ControlGroups(bool enabled) {
  if (!enabled) return;
  own_ =
      control_group_path(text_of_file("/proc/self/cgroup"), text_of_file("/proc/self/mountinfo"));
  if (own_.empty() || access((own_ / "cgroup.procs").c_str(), W_OK) != 0) return;
  remove_groups_of_killed_sweeps(own_);
  std::string name = own_ / (std::string(kPrefix) + "XXXXXX");
  if (mkdtemp(name.data()) == nullptr) return;
  folder_ = name;
  lock_ = lock_of(folder_);
  enable_controllers();
  if (can_be_entered(group_of_worker())) return;
  release();
  folder_.clear();
  limits_memory_ = false;
}

void ControlGroups::enable_controllers() {
  const std::string available = text_of_file(own_ / "cgroup.controllers");
  const std::string before = text_of_file(own_ / "cgroup.subtree_control");
  for (const std::string controller : {"memory", "pids"}) {
    if (!contains_word(available, controller)) continue;
    const auto enable = [&] {
      return write_setting(own_ / "cgroup.subtree_control", "+" + controller);
    };
    if (!contains_word(before, controller)) {
      bool is_enabled = enable();
      if (!is_enabled && !has_moved_ && mkdir((folder_ / "sweep").c_str(), 0700) == 0) {
        has_moved_ = write_setting(folder_ / "sweep/cgroup.procs", "0");
        is_enabled = has_moved_ && enable();
      }
      if (!is_enabled) continue;
      enabled_.append(enabled_.empty() ? "-" : " -").append(controller);
    }
    if (!write_setting(folder_ / "cgroup.subtree_control", "+" + controller)) continue;
    controllers_.append(", ").append(controller);
    if (controller == "memory") limits_memory_ = true;
  }
  if (has_moved_ && enabled_.empty()) {
    has_moved_ = !write_setting(own_ / "cgroup.procs", "0");
  }
}

ControlGroups::~ControlGroups() {
  if (!folder_.empty()) release();
}

void ControlGroups::release() {
  if (!enabled_.empty()) {
    write_setting(folder_ / "cgroup.subtree_control", enabled_);
    write_setting(own_ / "cgroup.subtree_control", enabled_);
  }
  if (has_moved_) write_setting(own_ / "cgroup.procs", "0");
  remove_groups(folder_);
  if (lock_ >= 0) close(lock_);
}

std::string ControlGroups::summary() const {
  return folder_.empty() ? "off" : "kill" + controllers_;
}

}  // namespace loopbench::harness
