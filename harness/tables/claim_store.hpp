/// Answers claims from stores.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "harness/compare/claim.hpp"

namespace loopbench::harness {

/// The claim's next look at a store. Throws InputError if its filters leave no score or several.
Look look_at_store(const Claim& claim, const std::filesystem::path& store);

/// What identifies a run in a claim: its options that differ from the defaults (`chosen`), and the
/// seed and the files of `all`, which lists all options ("NAME: a=1, seed=7; FILE BYTES HASH"). A
/// dataset can get a new option without another definition.
std::string definition_of_run(const std::string& chosen, const std::string& all);

/// The sequences that the claim is about: the name of each with the hash of the definitions of its
/// runs, which is the same on every machine.
std::map<std::string, std::string> sequences_of(const Claim& claim,
                                                const std::filesystem::path& store);

/// Throws InputError unless `now` has exactly the sequences that the claim names.
void require_same_sequences(const Claim& claim, const std::map<std::string, std::string>& now);

}  // namespace loopbench::harness
