#include "harness/execution/isolate/loaded_sequences.hpp"

#include <algorithm>

#include "harness/catalogue/load_sequence.hpp"
#include "harness/execution/run/sequences.hpp"

namespace loopbench::harness {
namespace {

std::size_t bytes_of(const Sequence& s) {
  return sizeof(StampedPose) *
             (s.reference.size() + s.problem.keyframes.size() + s.problem.frames.size()) +
         sizeof(Edge) * (s.problem.odometry.size() + s.problem.closures.size());
}

}  // namespace

const LoadedSequences::Entry* LoadedSequences::find(const Cell& cell) {
  const auto found = std::ranges::find_if(entries_, [&](const Entry& entry) {
    return entry.dataset == cell.dataset && entry.repeat == cell.repeat;
  });
  if (found == entries_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found);
  return &entries_.front();
}

const LoadedSequences::Entry& LoadedSequences::load(const Cell& cell) {
  Sequence sequence = load_sequence(cell, context_.sweep, context_.catalogue, context_.root);
  SequenceMetadata metadata = metadata_of(sequence, cell, context_.sweep);
  entries_.push_front({cell.dataset, cell.repeat, std::move(sequence), std::move(metadata)});
  std::size_t total = 0;
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    total += bytes_of(entry->sequence);
    const bool keep = entry == entries_.begin() || total <= kMostBytes;
    entry = keep ? std::next(entry) : entries_.erase(entry);
  }
  return entries_.front();
}

}  // namespace loopbench::harness
