/// Sequence metadata of a store.
#pragma once

#include <cstdint>
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
};

using SequenceRows = std::map<std::string, SequenceRow>;  ///< by CellKeys::sequence_key

/// Reads the tables sequence and input; the checksums of cells cover the former. O(rows).
SequenceRows read_sequence_rows(Database& database);

}  // namespace loopbench::harness
