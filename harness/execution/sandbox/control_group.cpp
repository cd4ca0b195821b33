#include "harness/execution/sandbox/control_group.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <sstream>
#include <system_error>
#include <thread>

#include "harness/execution/sandbox/system_file.hpp"
#include "harness/execution/sandbox/try_in_child.hpp"

namespace loopbench::harness {
namespace {

using std::filesystem::path;

constexpr const char* kPrefix = "loopbench-";
constexpr const char* kMostTasks = "4096";  // processes and threads of a worker with its cell

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
  write_system_file(path_ / "memory.swap.max", "0");
  write_system_file(path_ / "pids.max", kMostTasks);
}

bool ControlGroup::enter() const {
  return !path_.empty() && write_system_file(path_ / "cgroup.procs", "0");
}

void ControlGroup::limit_growth(std::int64_t growth) const {
  if (path_.empty()) return;
  const std::string now = read_system_file(path_ / "memory.current");
  if (now.empty()) return;
  write_system_file(path_ / "memory.max", std::to_string(std::stoll(now) + growth));
}

void ControlGroup::remove_limit() const {
  if (!path_.empty()) write_system_file(path_ / "memory.max", "max");
}

std::int64_t ControlGroup::ended_by_limit() const {
  if (path_.empty()) return 0;
  std::istringstream in(read_system_file(path_ / "memory.events"));
  std::string event;
  for (std::int64_t count = 0; in >> event >> count;) {
    if (event == "oom_kill") return count;
  }
  return 0;
}

void ControlGroup::kill() const {
  if (!path_.empty()) write_system_file(path_ / "cgroup.kill", "1");
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
  own_ = control_group_path(read_system_file("/proc/self/cgroup"),
                            read_system_file("/proc/self/mountinfo"));
  if (own_.empty() || access((own_ / "cgroup.procs").c_str(), W_OK) != 0) return;
  remove_groups_of_killed_sweeps(own_);
  std::string name = own_ / (std::string(kPrefix) + "XXXXXX");
  if (mkdtemp(name.data()) == nullptr) return;
  folder_ = name;
  lock_ = lock_of(folder_);
  enable_controllers();
  const ControlGroup group = group_of_worker();
  if (try_in_child([&] { return group.enter(); })) return;
  release();
  folder_.clear();
  limits_memory_ = false;
}

void ControlGroups::enable_controllers() {
  const std::string available = read_system_file(own_ / "cgroup.controllers");
  const std::string before = read_system_file(own_ / "cgroup.subtree_control");
  for (const std::string controller : {"memory", "pids"}) {
    if (!contains_word(available, controller)) continue;
    const auto enable = [&] {
      return write_system_file(own_ / "cgroup.subtree_control", "+" + controller);
    };
    if (!contains_word(before, controller)) {
      bool is_enabled = enable();
      if (!is_enabled && !has_moved_ && mkdir((folder_ / "sweep").c_str(), 0700) == 0) {
        has_moved_ = write_system_file(folder_ / "sweep/cgroup.procs", "0");
        is_enabled = has_moved_ && enable();
      }
      if (!is_enabled) continue;
      enabled_.append(enabled_.empty() ? "-" : " -").append(controller);
    }
    if (!write_system_file(folder_ / "cgroup.subtree_control", "+" + controller)) continue;
    controllers_.append(", ").append(controller);
    if (controller == "memory") limits_memory_ = true;
  }
  if (has_moved_ && enabled_.empty()) {
    has_moved_ = !write_system_file(own_ / "cgroup.procs", "0");
  }
}

ControlGroups::~ControlGroups() {
  if (!folder_.empty()) release();
}

void ControlGroups::release() {
  if (!enabled_.empty()) {
    write_system_file(folder_ / "cgroup.subtree_control", enabled_);
    write_system_file(own_ / "cgroup.subtree_control", enabled_);
  }
  if (has_moved_) write_system_file(own_ / "cgroup.procs", "0");
  remove_groups(folder_);
  if (lock_ >= 0) close(lock_);
}

std::string ControlGroups::summary() const {
  return folder_.empty() ? "off" : "kill" + controllers_;
}

}  // namespace loopbench::harness
