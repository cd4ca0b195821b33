#include "datasets/rgbd/pack_stages.hpp"

#include "datasets/core/pack.hpp"

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
namespace {

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

}  // namespace

std::string packed(const FrameFeatures& frame) {
  Packer pack;
  pack(frame.why)(frame.features);
  return pack.bytes();
}

FrameFeatures deserialise_frame(const std::string& bytes) {
  FrameFeatures out;
  Unpacker{bytes}(out.why)(out.features);
  return out;
}

std::string packed(const TrackingResult& tracked) { return serialised(tracked); }
TrackingResult deserialise_tracked(const std::string& bytes) {
  return deserialised<TrackingResult>(bytes);
}
std::string packed(const DetectedLoops& loops) { return serialised(loops); }
DetectedLoops deserialise_loops(const std::string& bytes) {
  return deserialised<DetectedLoops>(bytes);
}
std::string packed(const RefinedEdges& edges) { return serialised(edges); }
RefinedEdges deserialise_edges(const std::string& bytes) {
  return deserialised<RefinedEdges>(bytes);
}

}  // namespace loopbench::rgbd
