/// Members of the types that processes of a sweep exchange, each list used for both directions. In
/// the namespace of the serialiser, which finds them there.
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "datasets/core/pack.hpp"
#include "datasets/core/sequence.hpp"
#include "harness/sweep/model/cell_fields.hpp"
#include "harness/sweep/model/result.hpp"
#include "harness/sweep/model/sweep.hpp"

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

template <class Archive, Either<harness::Quantity> T>
void walk(Archive& a, T& number) {
  a(number.name)(number.value)(number.unit);
}

template <class Archive, Either<harness::Note> T>
void walk(Archive& a, T& note) {
  a(note.kind)(note.severity)(note.subject)(note.numbers);
  a(note.remedy.option)(note.remedy.value)(note.detail);
}

template <class Archive, Either<harness::SequenceMetadata> T>
void walk(Archive& a, T& metadata) {
  a(metadata.inputs)(metadata.closures)(metadata.oracle_closures)(metadata.size)(metadata.notes);
  a(metadata.content)(metadata.source)(metadata.group);
  a(metadata.group_kind)(metadata.recording);
  a(metadata.trace.origin)(metadata.trace.reference)(metadata.trace.keyframes)(
      metadata.trace.closures)(metadata.trace.ledger);
}

template <class Archive, Either<harness::Worker> T>
void walk(Archive& a, T& worker) {
  a(worker.isolated)(worker.serial)(worker.pinned)(worker.stated);
}

template <class Archive, Either<harness::TraceValues> T>
void walk(Archive& a, T& values) {
  a(values.name)(values.unit)(values.values);
}

/// All members except the metadata of its sequence, which are sent once for all its cells.
template <class Archive, Either<harness::CellResult> T>
void walk(Archive& a, T& r) {
  a(r.cell)(r.status)(r.why)(r.signal)(r.worker)(r.oracle_method)(r.seconds)(r.cpu_seconds);
  harness::measured_fields(r, [&](const harness::CellField&, auto& fact) { a(fact); });
  a(r.report.phases)(r.report.counts)(r.report.notes)(r.report.sections)(r.notes);
  a(r.scores)(r.trace.times)(r.trace.samples)(r.trace.values);
}

template <>
inline constexpr bool kIsPlain<Pose> = true;
template <>
inline constexpr bool kIsPlain<StampedPose> = true;
template <>
inline constexpr bool kIsPlain<Matrix6> = true;

template <>
inline constexpr bool kIsPlain<Anchor> = true;

template <class Archive, Either<Edge> T>
void walk(Archive& a, T& edge) {
  a(edge.from)(edge.to)(edge.from_from_to)(edge.information)(edge.scale);
  a(edge.scale_information);
}

template <class Archive, Either<Problem> T>
void walk(Archive& a, T& p) {
  a(p.keyframes)(p.odometry)(p.closures)(p.frames)(p.planar)(p.shared_landmarks)(p.anchors)(p.ids);
}

template <class Archive, Either<std::filesystem::path> T>
void walk(Archive& a, T& path) {
  std::string text = path.string();
  a(text);
  if constexpr (!std::is_const_v<T>) path = text;
}

template <class Archive, Either<InputPath> T>
void walk(Archive& a, T& input) {
  a(input.path)(input.option);
}

template <class Archive, Either<Provenance> T>
void walk(Archive& a, T& p) {
  a(p.sensor)(p.closures)(p.oracle_closures)(p.licence)(p.inputs)(p.notes);
  a(p.body_from_reference)(p.reference)(p.noise)(p.fixed)(p.held);
  a(p.file_body_from_body);
}

template <class Archive, Either<LoopCandidate> T>
void walk(Archive& a, T& candidate) {
  a(candidate.from)(candidate.to)(candidate.score)(candidate.accepted);
}

template <class Archive, Either<Sequence> T>
void walk(Archive& a, T& s) {
  a(s.name)(s.problem)(s.reference)(s.provenance)(s.loop_candidates)(s.false_closures);
}

/// The bytes of the values, one after another.
template <class... T>
std::string packed(const T&... values) {
  Packer pack;
  (pack(values), ...);
  return pack.bytes();
}

/// False if the bytes are not these values.
template <class... T>
bool unpack(std::string_view bytes, T&... values) {
  try {
    Unpacker unpacker(bytes);
    (unpacker(values), ...);
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

/// Whether a result can be used: a cell that wrote over its memory can send anything.
inline bool is_valid(const harness::CellResult& result, const harness::Sweep& sweep) {
  const auto is_choice = [](auto value) {
    return std::ranges::any_of(choices(value), [&](const auto& c) { return c.second == value; });
  };
  return is_choice(result.status) && is_choice(result.trace.times) &&
         std::ranges::all_of(result.notes,
                             [&](const harness::Note& note) {
                               return is_choice(note.kind) && is_choice(note.severity);
                             }) &&
         std::ranges::all_of(result.scores, [&](const harness::ScoreResult& score) {
           return score.protocol < sweep.protocols.size() && is_choice(score.times) &&
                  is_choice(score.status) && is_choice(score.score.better) &&
                  std::isfinite(score.score.target);
         });
}

}  // namespace loopbench
