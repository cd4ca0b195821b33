#include "harness/run/describe_sequence.hpp"

#include <algorithm>

#include "harness/base/shortened.hpp"
#include "harness/run/check_output.hpp"
#include "harness/run/doctor_notes.hpp"
#include "harness/run/evaluation_notes.hpp"
#include "harness/run/summarise_sequence.hpp"

namespace loopbench::harness {
namespace {

/// A dataset of a plugin can return any text, which would be printed and stored for every cell.
void limit_texts(SequenceMetadata& metadata) {
  metadata.closures = shortened(metadata.closures, kLongestNote);
  const std::size_t omitted = metadata.notes.size() - std::min(metadata.notes.size(), kMostItems);
  metadata.notes.resize(metadata.notes.size() - omitted);
  for (std::string& note : metadata.notes) note = shortened(note, kLongestNote);
  if (omitted > 0) metadata.notes.push_back(std::to_string(omitted) + " more notes");
}

}  // namespace

SequenceMetadata metadata_of(const Sequence& sequence, const Cell& cell, const Sweep& sweep) {
  SequenceMetadata out = sequence_metadata(sequence, sweep.traces);
  const std::string& group = sweep.datasets[cell.dataset].group;
  if (!group.empty()) out.group = "group:" + group;
  for (const auto& notes : {evaluation_notes(sequence, sweep), doctor_notes(sequence, sweep)}) {
    out.notes.insert(out.notes.end(), notes.begin(), notes.end());
  }
  limit_texts(out);
  return out;
}

}  // namespace loopbench::harness
