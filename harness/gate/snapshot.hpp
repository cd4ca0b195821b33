/// A store as the gate sees it.
#pragma once

#include <filesystem>

#include "harness/gate/baseline.hpp"

namespace loopbench {

/// The numbers of a store that `limits` are about, with all options of its sequences, the hashes of
/// the files they were read from, and the rules of its protocols. Throws InputError when it is not
/// a store or holds no cell.
Snapshot snapshot(const std::filesystem::path& store, const std::vector<Tolerance>& limits);

/// What a baseline taken from this store was made by.
std::map<std::string, std::string> made_by(const std::filesystem::path& store);

}  // namespace loopbench
