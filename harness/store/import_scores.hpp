/// Scores that were computed elsewhere, put back into a store.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "metrics/evaluation/evaluation.hpp"
#include "metrics/metric.hpp"

namespace loopbench::harness {

/// Protocol of imported scores; the labels of their metrics end with " (imported)".
inline constexpr const char* kImported = "imported";

struct ImportedScore {
  std::string source;  ///< "scores.csv:3", for messages
  std::string key;     ///< of the cell
  metrics::Times times = metrics::Times::keyframes;
  std::string metric;
  metrics::Score score;
};

/// Adds the scores to the cells with their keys, in one transaction; those with the same labels as
/// earlier imported ones replace them. Returns the number of changed cells. Throws InputError if
/// no cell has a key, another sweep is writing, or the file is not a store. O(scores).
std::size_t import_scores(const std::filesystem::path& store,
                          const std::vector<ImportedScore>& scores);

}  // namespace loopbench::harness
