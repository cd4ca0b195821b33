#include "harness/execution/sandbox/landlock.hpp"

#include <fcntl.h>
#include <linux/landlock.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <system_error>

namespace loopbench::harness {
namespace {

namespace fs = std::filesystem;

/// As the kernel defines it since 6.12; older headers end after the first member.
struct RulesetAttributes {
  std::uint64_t files = 0;
  std::uint64_t network = 0;
  std::uint64_t scoped = 0;
};

constexpr std::uint64_t kRead =
    LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t kReadFile = LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_READ_FILE;

/// All rights of the interface: 13 in its first version, then renaming between folders, then
/// truncation.
std::uint64_t all_rights(int version) {
  const int count = version >= 3 ? 15 : version == 2 ? 14 : 13;
  return (std::uint64_t{1} << count) - 1;
}

std::size_t attributes_size(int version) {
  if (version >= 6) return sizeof(RulesetAttributes);
  return (version >= 4 ? 2 : 1) * sizeof(std::uint64_t);
}

void add_rule(int rules, const fs::path& path, std::uint64_t rights) {
  landlock_path_beneath_attr rule{};
  rule.allowed_access = rights;
  rule.parent_fd = open(path.c_str(), O_PATH | O_CLOEXEC);
  if (rule.parent_fd < 0) return;  // not there: stays unreachable
  syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
  close(rule.parent_fd);
}

bool is_inside(const fs::path& path, const fs::path& folder) {
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end();
}

constexpr const char* kStore = "results.sqlite";

/// Whether the path is a store of results, or a folder with one or with those of its shards.
bool has_results(const fs::path& folder) {
  std::error_code error;
  if (folder.filename() == kStore) return true;
  if (fs::exists(folder / kStore, error)) return true;
  for (const fs::directory_entry& shard : fs::directory_iterator(folder / "shards", error)) {
    if (fs::exists(shard.path() / kStore, error)) return true;
  }
  return false;
}

void permit_reading(int rules, const fs::path& path, const std::vector<fs::path>& unreachable) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  if (error || fs::is_symlink(status)) return;  // rights belong to the target
  if (std::ranges::count(unreachable, path) > 0) return;
  const bool is_folder = fs::is_directory(status);
  const bool all = std::ranges::none_of(
      unreachable, [&](const fs::path& hidden) { return is_inside(hidden, path); });
  const bool is_beside = std::ranges::any_of(unreachable, [&](const fs::path& hidden) {
    return hidden.parent_path() == path.parent_path();
  });
  if (all && is_beside && has_results(path)) return;
  if (all) return add_rule(rules, path, is_folder ? kRead : kReadFile);
  if (!is_folder) return;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, error)) {
    permit_reading(rules, entry.path(), unreachable);
  }
}

}  // namespace

int landlock_version() {
  const long version =
      syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  return version < 0 ? 0 : static_cast<int>(version);
}

int landlock_rules(const std::vector<fs::path>& unreachable,
                   const std::vector<fs::path>& writable) {
  const int version = landlock_version();
  if (version == 0) return -1;
  constexpr std::uint64_t kTcp = 3;                // binding and connecting
  constexpr std::uint64_t kSocketsAndSignals = 3;  // abstract sockets and signals out of the domain
  const RulesetAttributes attributes{all_rights(version), kTcp, kSocketsAndSignals};
  const int rules = static_cast<int>(
      syscall(SYS_landlock_create_ruleset, &attributes, attributes_size(version), 0));
  if (rules < 0) return -1;
  std::vector<fs::path> hidden;
  for (const fs::path& path : unreachable) {
    std::error_code error;
    const fs::path absolute = fs::weakly_canonical(path, error);
    if (error || is_inside("/usr", absolute)) continue;  // no program runs without it
    hidden.push_back(absolute.has_filename() ? absolute : absolute.parent_path());
  }
  permit_reading(rules, "/", hidden);
  for (const fs::path& folder : writable) add_rule(rules, folder, all_rights(version));
  add_rule(rules, "/dev/null", kReadFile | LANDLOCK_ACCESS_FS_WRITE_FILE);
  return rules;
}

bool landlock_restrict(int rules) { return syscall(SYS_landlock_restrict_self, rules, 0) == 0; }

}  // namespace loopbench::harness
