/// Provenance of a store's numbers, formatted for each output format.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "harness/answers/notes/counted_notes.hpp"
#include "harness/sweep/model/sequence_metadata.hpp"

namespace loopbench::harness {

struct StoreProvenance {
  std::map<std::string, std::string> run;                ///< config text, protocols, baseline
  std::map<std::string, std::string> provenance;         ///< commit, build, machine, seeds
  std::map<std::string, std::vector<InputFile>> inputs;  ///< by sequence
  std::vector<CountedNote> notes;
};

/// Throws InputError if it is not a store.
StoreProvenance read_store_provenance(const std::filesystem::path& store);

/// {run, provenance, inputs: {SEQUENCE: [{path, bytes, xxh3_128}]}, notes}, for the file next to a
/// CSV.
std::string json(const StoreProvenance& provenance);

/// {"provenance": PROVENANCE, KEY: VALUE}; `value` is JSON.
std::string with_provenance(const StoreProvenance& provenance,
                            const std::string& key,
                            const std::string& value);

/// One line per entry, each prefixed with `mark`: "% commit: ...". Control characters become
/// spaces. Absolute paths are cut to their last two parts.
std::string provenance_lines(const StoreProvenance& provenance, const std::string& mark);

/// HTML comment, which Markdown hides. `--` becomes `- -`, so that no value can end it.
std::string provenance_comment(const StoreProvenance& provenance);

/// "table.csv" -> "table.provenance.json".
std::filesystem::path provenance_file(const std::filesystem::path& file);

}  // namespace loopbench::harness
