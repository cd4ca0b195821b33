/// Serialised members of the types sent by workers, each list used for both directions.
#pragma once

#include <concepts>

#include "harness/execution/isolate/pack.hpp"
#include "harness/model/result.hpp"

namespace loopbench::harness {

template <class Archive, class T>
requires std::same_as<std::remove_const_t<T>, methods::Phase>
void walk(Archive& a, T& phase) { a(phase.name)(phase.seconds); }

template <class Archive, class T>
requires std::same_as<std::remove_const_t<T>, methods::Count>
void walk(Archive& a, T& count) { a(count.name)(count.value); }

template <class Archive, class T>
requires std::same_as<std::remove_const_t<T>, methods::Section>
void walk(Archive& a, T& section) { a(section.kind)(section.begin)(section.end)(section.what); }

template <class Archive, class T>
requires std::same_as<std::remove_const_t<T>, metrics::Score>
void walk(Archive& a, T& score) {
  a(score.relation)(score.axis)(score.unit)(score.statistics)(score.why_undefined)(score.better)(
      score.target);
}

template <class Archive, class T>
requires std::same_as<std::remove_const_t<T>, ScoreResult>
void walk(Archive& a, T& r) {
  a(r.protocol)(r.times)(r.metric)(r.label)(r.score)(r.coverage)(r.status)(r.why);
}

template <class Archive, class T>
requires std::same_as<std::remove_const_t<T>, InputFile>
void walk(Archive& a, T& file) { a(file.option)(file.path)(file.bytes)(file.hash); }

template <class Archive, class T>
requires std::same_as<std::remove_const_t<T>, SequenceMetadata>
void walk(Archive& a, T& metadata) {
  a(metadata.inputs)(metadata.closures)(metadata.oracle_closures)(metadata.size)(metadata.notes);
  a(metadata.content)(metadata.source)(metadata.group);
  a(metadata.trace.origin)(metadata.trace.reference)(metadata.trace.keyframes)(
      metadata.trace.closures);
}

/// All members except the metadata of its sequence, which are sent once for all its cells.
template <class Archive, class T>
requires std::same_as<std::remove_const_t<T>, CellResult>
void walk(Archive& a, T& r) {
  a(r.cell)(r.status)(r.why)(r.signal)(r.worker)(r.oracle_method)(r.seconds)(r.cpu_seconds);
  a(r.peak_memory)(r.added_memory)(r.allocations);
  a(r.report.phases)(r.report.counts)(r.report.notes)(r.report.sections);
  a(r.scores)(r.trace.times)(r.trace.samples);
}

}  // namespace loopbench::harness
