/// What is kept about a sequence once it is loaded: what it was read from, what a report draws.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/model/trace.hpp"

namespace loopbench {

/// A file that a dataset read.
struct InputFile {
  std::string option;  ///< of the dataset that names it; empty: found by the dataset
  std::string path;    ///< as it was found
  std::uint64_t bytes = 0;
  std::string hash;  ///< of its content, see text/hash.hpp; "missing" when it is not there
};

/// How much a method is given.
struct SequenceSize {
  std::int64_t keyframes = 0;
  std::int64_t odometry = 0;  ///< edges
  std::int64_t closures = 0;
  std::int64_t frames = 0;     ///< tracked between keyframes
  std::int64_t reference = 0;  ///< poses the judge has
};

struct SequenceFacts {
  std::vector<InputFile> inputs;
  std::string closures;          ///< where the loop closures came from
  bool oracle_closures = false;  ///< the reference measured or selected them
  SequenceSize size;
  std::string content;  ///< hash of problem and reference: equal content is one observation
  std::string source;   ///< recording or noise, see source_of()
  std::string group;    ///< runs of one group are not independent: the source, or `group:NAME`
  std::vector<std::string> notes;  ///< what a user should know of how it was made
  SequenceTrace trace;             ///< empty when the sweep keeps no traces
};

}  // namespace loopbench
