/// Reads and writes claim files.
#pragma once

#include <filesystem>
#include <string>

#include "harness/model/claim.hpp"

namespace loopbench::harness {

/// Throws InputError `file:line: key: what is accepted`.
Claim parse_claim(const std::string& text, const std::filesystem::path& file);

/// A new claim file with all keys, `looks` last.
std::string yaml(const Claim& claim);

/// `text` with the look as its last line. Throws InputError if the result does not read back with
/// one look more, for example because `looks` is not the last key.
std::string with_look(const std::string& text, const std::filesystem::path& file, const Look& look);

}  // namespace loopbench::harness
