#include "datasets/rgbd/pack_stages.hpp"

#include "datasets/rgbd/cache.hpp"

namespace loopbench::rgbd {
namespace {

// Lists of members, used for both writing and reading: io(member) does either.
template <class Io, class T>
void each(Io&& io, T& pose, const Pose*) {
  for (int i = 0; i < 4; ++i) io(pose.rotation.coeffs()[i]);
  for (int i = 0; i < 3; ++i) io(pose.translation[i]);
}

template <class Io, class T>
void each(Io&& io, T& edge, const Edge*) {
  io(edge.from), io(edge.to), io(edge.from_from_to), io(edge.scale);
  for (int i = 0; i < 36; ++i) io(edge.information.data()[i]);
}

template <class Io, class T>
void each(Io&& io, T& f, const Features*) {
  io(f.points), io(f.descriptors), io(f.bytes), io(f.binary);
}

template <class Io, class T>
void each(Io&& io, T& k, const Keyframe*) {
  io(k.frame), io(k.stamp), io(k.world_from_camera), io(k.features);
}

template <class Io, class T>
void each(Io&& io, T& p, const StampedPose*) {
  io(p.stamp), io(p.world_from_body);
}

template <class Io, class T>
void each(Io&& io, T& t, const TrackingResult*) {
  io(t.keyframes), io(t.odometry), io(t.shared_landmarks), io(t.frames), io(t.lost), io(t.skipped),
      io(t.notes);
}

template <class Io, class T>
void each(Io&& io, T& c, const LoopCandidate*) {
  io(c.from), io(c.to), io(c.score), io(c.accepted);
}

template <class Io, class T>
void each(Io&& io, T& loops, const DetectedLoops*) {
  io(loops.closures), io(loops.candidates);
}

template <class Io, class T>
void each(Io&& io, T& e, const RefinedEdges*) {
  io(e.odometry), io(e.closures), io(e.odometry_refined), io(e.closures_refined);
}

template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_same_v<T, Feature>;

struct Write {
  Pack pack = {};
  template <class T>
  void operator()(const T& value) {
    if constexpr (Plain<T>) {
      pack.put(value);
    } else {
      each(*this, value, static_cast<const T*>(nullptr));
    }
  }
  void operator()(const std::string& text) { pack.put(text); }
  template <class T>
  void operator()(const std::vector<T>& list) {
    if constexpr (Plain<T>) {
      pack.put(list);
    } else {
      pack.put(list.size());
      for (const T& item : list) (*this)(item);
    }
  }
};

struct Read {
  Unpack pack;
  template <class T>
  void operator()(T& value) {
    if constexpr (Plain<T>) {
      pack.get(value);
    } else {
      each(*this, value, static_cast<const T*>(nullptr));
    }
  }
  void operator()(std::string& text) { pack.get(text); }
  template <class T>
  void operator()(std::vector<T>& list) {
    if constexpr (Plain<T>) {
      pack.get(list);
    } else {
      std::size_t count = 0;
      pack.get(count);
      for (std::size_t i = 0; i < count;
           ++i) {  // grown step by step: a wrong count throws at the end
        list.emplace_back();
        (*this)(list.back());
      }
    }
  }
};

template <class T>
std::string serialised(const T& value) {
  Write write;
  write(value);
  return write.pack.bytes();
}

template <class T>
T read(const std::string& bytes) {
  T out;
  Read from{Unpack(bytes)};
  from(out);
  return out;
}

}  // namespace

std::string packed(const FrameFeatures& frame) {
  Write write;
  write(frame.why);
  write(frame.features.has_value());
  if (frame.features) write(*frame.features);
  return write.pack.bytes();
}

FrameFeatures deserialise_frame(const std::string& bytes) {
  FrameFeatures out;
  Read from{Unpack(bytes)};
  bool any = false;
  from(out.why);
  from(any);
  if (any) from(out.features.emplace());
  return out;
}

std::string packed(const TrackingResult& tracked) { return serialised(tracked); }
TrackingResult deserialise_tracked(const std::string& bytes) { return read<TrackingResult>(bytes); }
std::string packed(const DetectedLoops& loops) { return serialised(loops); }
DetectedLoops deserialise_loops(const std::string& bytes) { return read<DetectedLoops>(bytes); }
std::string packed(const RefinedEdges& edges) { return serialised(edges); }
RefinedEdges deserialise_edges(const std::string& bytes) { return read<RefinedEdges>(bytes); }

}  // namespace loopbench::rgbd
