/// Members of a sequence, each list used for both directions.
#pragma once

#include "datasets/core/pack.hpp"
#include "datasets/core/sequence.hpp"

namespace loopbench {

template <>
inline constexpr bool kIsPlain<Pose> = true;
template <>
inline constexpr bool kIsPlain<StampedPose> = true;
template <>
inline constexpr bool kIsPlain<Matrix6> = true;

template <class Archive, Either<Edge> T>
void walk(Archive& a, T& edge) {
  a(edge.from)(edge.to)(edge.from_from_to)(edge.information)(edge.scale);
}

template <class Archive, Either<Problem> T>
void walk(Archive& a, T& p) {
  a(p.keyframes)(p.odometry)(p.closures)(p.frames)(p.planar)(p.shared_landmarks);
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
  a(p.body_from_reference)(p.reference)(p.noise);
}

template <class Archive, Either<LoopCandidate> T>
void walk(Archive& a, T& candidate) {
  a(candidate.from)(candidate.to)(candidate.score)(candidate.accepted);
}

template <class Archive, Either<Sequence> T>
void walk(Archive& a, T& s) {
  a(s.name)(s.problem)(s.reference)(s.provenance)(s.loop_candidates);
}

}  // namespace loopbench
