// Serialisation of the results of front-end stages.
#include "datasets/core/pack.hpp"
#include "datasets/rgbd/stage_cache.hpp"

// Members of the types, each list used for both writing and reading. In the namespace of the
// serialiser, which finds them there.
namespace loopbench {

template <class Archive, Either<Pose> T>
void walk(Archive& a, T& pose) {
  for (int i = 0; i < 4; ++i) a(pose.rotation.coeffs()[i]);
  for (int i = 0; i < 3; ++i) a(pose.translation[i]);
}

template <class Archive, Either<Edge> T>
void walk(Archive& a, T& edge) {
  a(edge.from)(edge.to)(edge.from_from_to)(edge.scale);
  for (int i = 0; i < 36; ++i) a(edge.information.data()[i]);
}

template <class Archive, Either<StampedPose> T>
void walk(Archive& a, T& p) {
  a(p.stamp)(p.world_from_body);
}

template <class Archive, Either<rgbd::Features> T>
void walk(Archive& a, T& f) {
  a(f.points)(f.descriptors)(f.bytes)(f.binary);
}

template <class Archive, Either<rgbd::FrameFeatures> T>
void walk(Archive& a, T& frame) {
  a(frame.why)(frame.features);
}

template <class Archive, Either<rgbd::Keyframe> T>
void walk(Archive& a, T& k) {
  a(k.frame)(k.stamp)(k.world_from_camera)(k.features);
}

template <class Archive, Either<rgbd::TrackingResult> T>
void walk(Archive& a, T& t) {
  a(t.keyframes)(t.odometry)(t.shared_landmarks)(t.frames)(t.lost)(t.skipped)(t.notes);
}

template <class Archive, Either<LoopCandidate> T>
void walk(Archive& a, T& c) {
  a(c.from)(c.to)(c.score)(c.accepted);
}

template <class Archive, Either<rgbd::DetectedLoops> T>
void walk(Archive& a, T& loops) {
  a(loops.closures)(loops.candidates);
}

template <class Archive, Either<rgbd::RefinedEdges> T>
void walk(Archive& a, T& e) {
  a(e.odometry)(e.closures)(e.odometry_refined)(e.closures_refined);
}

}  // namespace loopbench

namespace loopbench::rgbd {

template <class T>
std::string serialised(const T& value) {
  return Packer{}(value).bytes();
}

template <class T>
T deserialised(const std::string& bytes) {
  T out;
  Unpacker{bytes}(out);
  return out;
}

template std::string serialised(const FrameFeatures&);
template std::string serialised(const TrackingResult&);
template std::string serialised(const DetectedLoops&);
template std::string serialised(const RefinedEdges&);
template FrameFeatures deserialised<FrameFeatures>(const std::string&);
template TrackingResult deserialised<TrackingResult>(const std::string&);
template DetectedLoops deserialised<DetectedLoops>(const std::string&);
template RefinedEdges deserialised<RefinedEdges>(const std::string&);

}  // namespace loopbench::rgbd
