/// Lines of g2o files that measure the position of one vertex.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "datasets/core/anchor.hpp"
#include "datasets/formats/text_file.hpp"

namespace loopbench {

/// Line that measures the position of a vertex.
struct PriorRecord {
  std::int64_t id = 0;
  Anchor anchor;  ///< keyframe not set
  std::size_t line = 0;
};

/// Reads a line whose tag is `word`; nullopt if that is no prior. Throws InputError for a wrong
/// number of columns and information of the position that is not positive definite. O(1).
std::optional<PriorRecord> read_prior(const TextFile& file,
                                      const Line& line,
                                      std::string_view word);

}  // namespace loopbench
