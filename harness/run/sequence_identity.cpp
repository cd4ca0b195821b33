#include "harness/run/sequence_identity.hpp"

#include <cmath>

#include "harness/base/hash.hpp"

namespace loopbench::harness {
namespace {

/// Serialises numbers, members one by one, because padding has undefined values.
class ContentHash {
 public:
  void add(double value) { append(&value, sizeof value); }
  void add(std::uint64_t value) { append(&value, sizeof value); }

  void add(const Pose& pose) {
    for (const double x : pose.translation) add(x);
    for (const double x : pose.rotation.coeffs()) add(x);
  }

  void add(const Trajectory& poses) {
    add(std::uint64_t{poses.size()});
    for (const auto& [stamp, pose] : poses) {
      add(stamp);
      add(pose);
    }
  }

  void add(const std::vector<Edge>& edges) {
    add(std::uint64_t{edges.size()});
    for (const Edge& edge : edges) {
      add(std::uint64_t{edge.from});
      add(std::uint64_t{edge.to});
      add(edge.from_from_to);
      for (const double x : edge.information.reshaped()) add(x);
      add(edge.scale);
    }
  }

  std::string text() { return hex(hash_of(bytes_)); }

 private:
  static constexpr std::size_t kMostBytes = std::size_t{1} << 20;

  void append(const void* data, std::size_t size) {
    if (bytes_.size() + size > kMostBytes) bytes_ = text();
    bytes_.append(static_cast<const char*>(data), size);
  }

  std::string bytes_;  ///< data not yet hashed, after the hash of the preceding data
};

/// Hash of the distances from the first position, which do not depend on the format of the file,
/// on the world frame or the axes, nor on the body, whose offset is undone. Formats and the offset
/// change the last digits, so distances are rounded; few decimal numbers are near a limit of the
/// cells, because of their fraction.
std::string hash_of_shape(const Trajectory& poses, const Pose& body_from_reference) {
  constexpr double kCell = 1e-3;  // [m]
  constexpr double kFraction = 0.3183;
  const auto position = [&](const StampedPose& one) -> Vector3 {
    return (one.world_from_body * body_from_reference).translation;
  };
  const Vector3 first = position(poses.front());
  ContentHash hash;
  hash.add(std::uint64_t{poses.size()});
  for (const StampedPose& one : poses) {
    hash.add(std::floor((position(one) - first).norm() / kCell + kFraction));
  }
  return hash.text();
}

}  // namespace

std::string hash_of_poses(const Trajectory& poses) {
  ContentHash hash;
  hash.add(poses);
  return hash.text();
}

std::string content_of(const Sequence& sequence) {
  const Problem& problem = sequence.problem;
  ContentHash hash;
  hash.add(problem.keyframes);
  hash.add(problem.odometry);
  hash.add(problem.closures);
  hash.add(problem.frames);
  hash.add(std::uint64_t{problem.planar});
  hash.add(std::uint64_t{problem.shared_landmarks.size()});
  for (const std::size_t count : problem.shared_landmarks) hash.add(std::uint64_t{count});
  for (const Anchor& anchor : problem.anchors) {
    hash.add(std::uint64_t{anchor.keyframe});
    for (const double x : anchor.position) hash.add(x);
    for (const double x : anchor.covariance.reshaped()) hash.add(x);
    for (const double x : anchor.point_in_body) hash.add(x);
  }
  hash.add(sequence.reference);
  return hash.text();
}

std::string source_of(const Sequence& sequence) {
  const std::string& noise = sequence.provenance.noise;
  if (!noise.empty()) return "noise:" + hex(hash_of(noise));
  if (!sequence.reference.empty()) {
    const Pose offset = sequence.provenance.body_from_reference.value_or(Pose{});
    return "reference:" + hash_of_shape(sequence.reference, offset);
  }
  return "estimate:" + hash_of_poses(sequence.problem.keyframes);
}

}  // namespace loopbench::harness
