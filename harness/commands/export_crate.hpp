/// `export --what crate`: the metadata of an RO-Crate.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace loopbench::harness {

/// Writes ro-crate-metadata.json into `folder`, which has these files of the store: results, and
/// `config`, an input of the run. It has the root dataset, file entities with size and SHA-256, the
/// run as CreateAction, the program and the input files with the hashes that the store has.
/// `datePublished` is the day (UTC) of the last change of the store, which has no time of the run.
/// Equal stores give equal bytes. Throws InputError.
///
/// Source: RO-Crate 1.1, https://w3id.org/ro/crate/1.1; sha256 is the term of schema.org.
void write_crate_metadata(const std::filesystem::path& store,
                          const std::filesystem::path& folder,
                          const std::vector<std::string>& files,
                          const std::string& config);

}  // namespace loopbench::harness
