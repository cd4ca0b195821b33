/// Landlock rule sets by plain system calls (Linux 5.13; signals and TCP since 6.12).
#pragma once

#include <filesystem>
#include <vector>

namespace loopbench::harness {

/// Version of the interface; 0 if the system has none.
int landlock_version();

/// Descriptor of a rule set that permits reading everything but `unreachable` and writing in
/// `writable` only; -1 if the system has no Landlock. Folders that contain an unreachable path are
/// permitted entry by entry, so entries created there later cannot be read, and neither can results
/// of other sweeps beside an unreachable path.
int landlock_rules(const std::vector<std::filesystem::path>& unreachable,
                   const std::vector<std::filesystem::path>& writable);

/// Restricts the calling thread; needs no_new_privs. False on failure.
bool landlock_restrict(int rules);

}  // namespace loopbench::harness
