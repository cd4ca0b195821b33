/// The contents of a store for the gate, and the definitions behind its labels.
#pragma once

#include <filesystem>

#include "harness/compare/baseline.hpp"

namespace loopbench::harness {

/// The numbers of a store that have `limits`, with all options of its sequences, the hashes of
/// their files, and the rules of its protocols. Throws InputError if it is not a store or has no
/// cells.
Snapshot snapshot(const std::filesystem::path& store, const std::vector<Tolerance>& limits);

/// Throws InputError if a sequence, protocol, metric or method of the baseline has the same label
/// in `now` but different options, stages, files or content; the message names the first difference
/// and the number of further ones. Labels that are missing in `now` are reported with their cells
/// and scores, except protocols. Contents of sequences are compared only between equal machines,
/// because the last digits of a simulated sequence can differ otherwise.
void require_same_definitions(const Snapshot& baseline, const Snapshot& now);

/// "contents are not compared ..." if this applies, otherwise empty.
std::string note_on_contents(const Snapshot& baseline, const Snapshot& now);

/// Provenance of a baseline from this store.
std::map<std::string, std::string> build_summary(const std::filesystem::path& store);

}  // namespace loopbench::harness
