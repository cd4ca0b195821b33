#include "harness/run/sequence_facts.hpp"

#include "harness/provenance/hash.hpp"
#include "metrics/loop_detection.hpp"

namespace loopbench {

std::vector<InputFile> hashed_inputs(const std::vector<std::filesystem::path>& files) {
  std::vector<InputFile> out;
  for (const std::filesystem::path& file : files) {
    if (!std::filesystem::exists(file)) {
      out.push_back({file.string(), 0, hex(Hash{})});
      continue;
    }
    const std::string hash = hex(hash_of_file(file));
    out.push_back({file.string(), std::filesystem::file_size(file), hash});
  }
  return out;
}

SequenceFacts sequence_facts(const Sequence& sequence, bool with_trace) {
  SequenceFacts out;
  out.inputs = hashed_inputs(sequence.provenance.inputs);
  out.closures = sequence.provenance.closures;
  out.oracle_closures = sequence.provenance.oracle_closures;
  const auto count = [](const auto& items) { return static_cast<std::int64_t>(items.size()); };
  const Problem& problem = sequence.problem;
  out.size = {count(problem.keyframes),
              count(problem.odometry),
              count(problem.closures),
              count(problem.frames),
              count(sequence.reference)};
  out.notes = sequence.provenance.notes;
  if (!sequence.loop_candidates.empty() && !sequence.reference.empty()) {
    out.notes.push_back(to_text(judge_detection(sequence, {})));
  }
  if (with_trace) out.trace = sequence_trace(sequence);
  return out;
}

}  // namespace loopbench
