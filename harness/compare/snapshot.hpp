/// The contents of a store for the gate.
#pragma once

#include <filesystem>

#include "harness/compare/baseline.hpp"

namespace loopbench::harness {

/// The numbers of a store that have `limits`, with all options of its sequences, the hashes of
/// their files, and the rules of its protocols. Throws InputError if it is not a store or has no
/// cells.
Snapshot snapshot(const std::filesystem::path& store, const std::vector<Tolerance>& limits);

/// Provenance of a baseline from this store.
std::map<std::string, std::string> build_summary(const std::filesystem::path& store);

}  // namespace loopbench::harness
