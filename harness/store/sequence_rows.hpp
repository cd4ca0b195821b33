/// Sequence metadata of a store, checked against digests.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "harness/model/sequence_metadata.hpp"
#include "harness/store/sqlite.hpp"

namespace loopbench::harness {

struct SequenceRow {
  std::string configuration_hash;  ///< CellKeys::configuration_hash
  std::string options;             ///< "DATASET: all options including defaults"
  std::int64_t keyframes = 0;
  std::int64_t closures = 0;
  std::string content;
  std::string group;
  std::vector<InputFile> inputs;
  std::string trace_digest;
  std::string digest;
  bool intact = false;  ///< it and its inputs are as written
};

struct SequenceRows {
  std::map<std::string, SequenceRow> by_key;  ///< CellKeys::sequence_key
  bool complete = false;                      ///< no row is missing
};

/// Reads the tables sequence and input. O(rows).
SequenceRows read_sequence_rows(Database& database);

/// Throws InputError if a row is damaged or missing.
void require_intact(const SequenceRows& rows, const std::filesystem::path& file);

}  // namespace loopbench::harness
