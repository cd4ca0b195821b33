/// Members of the types that workers send, each list used for both directions. In the namespace of
/// the serialiser, which finds them there.
#pragma once

#include "datasets/core/pack.hpp"
#include "harness/model/result.hpp"

namespace loopbench {

template <class Archive, Either<methods::Phase> T>
void walk(Archive& a, T& phase) {
  a(phase.name)(phase.seconds);
}

template <class Archive, Either<methods::Count> T>
void walk(Archive& a, T& count) {
  a(count.name)(count.value);
}

template <class Archive, Either<methods::Section> T>
void walk(Archive& a, T& section) {
  a(section.kind)(section.begin)(section.end)(section.what);
}

template <class Archive, Either<metrics::Score> T>
void walk(Archive& a, T& score) {
  a(score.relation)(score.axis)(score.unit)(score.statistics)(score.why_undefined)(score.better)(
      score.target);
}

template <class Archive, Either<harness::ScoreResult> T>
void walk(Archive& a, T& r) {
  a(r.protocol)(r.times)(r.metric)(r.label)(r.score)(r.coverage)(r.status)(r.why);
}

template <class Archive, Either<harness::InputFile> T>
void walk(Archive& a, T& file) {
  a(file.option)(file.path)(file.bytes)(file.hash);
}

template <class Archive, Either<harness::SequenceMetadata> T>
void walk(Archive& a, T& metadata) {
  a(metadata.inputs)(metadata.closures)(metadata.oracle_closures)(metadata.size)(metadata.notes);
  a(metadata.content)(metadata.source)(metadata.group);
  a(metadata.trace.origin)(metadata.trace.reference)(metadata.trace.keyframes)(
      metadata.trace.closures);
}

template <class Archive, Either<harness::Worker> T>
void walk(Archive& a, T& worker) {
  a(worker.isolated)(worker.serial)(worker.pinned);
}

/// All members except the metadata of its sequence, which are sent once for all its cells.
template <class Archive, Either<harness::CellResult> T>
void walk(Archive& a, T& r) {
  a(r.cell)(r.status)(r.why)(r.signal)(r.worker)(r.oracle_method)(r.seconds)(r.cpu_seconds);
  a(r.peak_memory)(r.added_memory);
  a(r.report.phases)(r.report.counts)(r.report.notes)(r.report.sections);
  a(r.scores)(r.trace.times)(r.trace.samples);
}

}  // namespace loopbench
