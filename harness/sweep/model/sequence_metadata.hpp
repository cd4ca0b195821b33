/// Metadata of a loaded sequence: input files, sizes, and data for the report's plots.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/sweep/model/note.hpp"
#include "harness/sweep/model/run_group.hpp"
#include "harness/sweep/model/trace.hpp"

namespace loopbench::harness {

/// A file that a dataset reads.
struct InputFile {
  std::string option;  ///< dataset option with the file name; empty: found by the dataset
  std::string path;    ///< path at which it was found
  std::uint64_t bytes = 0;
  std::string hash;  ///< of its content, see text/hash.hpp; "missing" if it does not exist
};

/// Size of a method's input.
struct SequenceSize {
  std::int64_t keyframes = 0;
  std::int64_t odometry = 0;  ///< edges
  std::int64_t closures = 0;
  std::int64_t frames = 0;     ///< frames tracked between keyframes
  std::int64_t reference = 0;  ///< reference poses
};

struct SequenceMetadata {
  std::vector<InputFile> inputs;
  std::string closures;          ///< source of the loop closures
  bool oracle_closures = false;  ///< the closures were measured or selected with the reference
  SequenceSize size;
  std::string content;  ///< hash of problem and reference: equal content is one observation
  std::string source;   ///< recording or noise, see source_of()
  std::string group;    ///< runs of one group are not independent: the source, or `group:NAME`
  GroupKind group_kind = GroupKind::none;
  std::string recording;    ///< equal if references are, or by a stated name; empty: unknown
  std::vector<Note> notes;  ///< what loading and the checks of its poses found
  SequenceTrace trace;      ///< empty if the sweep keeps no traces
};

}  // namespace loopbench::harness
