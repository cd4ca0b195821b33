/// Control groups (cgroup v2) of workers, where this process may create them. The kernel then also
/// limits growth between two checks and memory that no process maps, and kills a whole group at
/// once. Nothing else depends on them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

namespace loopbench::harness {

/// Group of one worker and every process it starts; kills them when it is destroyed. Does nothing
/// if it could not be created.
class ControlGroup {
 public:
  /// Creates the group in `parent`, unless that is empty.
  explicit ControlGroup(const std::filesystem::path& parent = {});
  ~ControlGroup() { end(); }
  ControlGroup(ControlGroup&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  ControlGroup& operator=(ControlGroup&&) = delete;

  /// Moves the calling process, whose later children are in the group, too. False without a group.
  bool enter() const;

  /// Limits the memory of the group to what it uses now plus `growth` [bytes].
  void limit_growth(std::int64_t growth) const;

  void remove_limit() const;

  /// Number of processes killed so far because of the limit.
  std::int64_t ended_by_limit() const;

  /// Kills all processes in the group.
  void kill() const;

 private:
  void end();

  std::filesystem::path path_;  ///< empty: none
};

/// The groups of a sweep.
class ControlGroups {
 public:
  /// Creates a folder in the group of this process, if that is permitted, and removes those of
  /// killed sweeps. Moves this process into the folder if that is needed to limit memory, because a
  /// group that contains processes cannot limit the groups in it. Starts a short-lived process to
  /// check that a group can be entered. Does nothing unless `enabled`.
  explicit ControlGroups(bool enabled);
  ~ControlGroups();
  ControlGroups(const ControlGroups&) = delete;
  ControlGroups& operator=(const ControlGroups&) = delete;

  ControlGroup group_of_worker() const { return ControlGroup(folder_); }

  const std::filesystem::path& folder() const { return folder_; }  ///< "": off

  bool limits_memory() const { return limits_memory_; }

  /// What is used: "off", "kill" or for example "kill, memory, pids".
  std::string summary() const;

 private:
  void enable_controllers();
  void release();

  std::filesystem::path own_;     ///< group of this process at the beginning
  std::filesystem::path folder_;  ///< in it; empty: off
  int lock_ = -1;                 ///< descriptor of the folder, locked while in use
  std::string controllers_;       ///< used: "memory", "pids"
  std::string enabled_;           ///< of them, those that this sweep has enabled in own_
  bool has_moved_ = false;
  bool limits_memory_ = false;
};

/// Folder of the group of a process from the texts of its cgroup and mountinfo files in /proc, ""
/// if it is not visible.
std::filesystem::path control_group_path(const std::string& cgroup, const std::string& mountinfo);

}  // namespace loopbench::harness
