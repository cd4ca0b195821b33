/// Run times in a store.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace loopbench::harness {

/// Visits every cell of the current config that has run: labels of its sequence and method, and the
/// CPU
/// time of all its timed runs, or the wall time if that is unknown [s]. Not checked against
/// digests. Throws InputError if it is not a store. O(cells).
void for_each_time(
    const std::filesystem::path& store,
    const std::function<void(const std::string& sequence, const std::string& method, double time)>&
        visit);

}  // namespace loopbench::harness
