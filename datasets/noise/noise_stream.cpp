#include "datasets/noise/noise_stream.hpp"

#include "datasets/core/hash.hpp"

namespace loopbench {
namespace {

constexpr std::uint64_t kSharedStream = 1;
constexpr std::uint64_t kOwnStream = 2;

}  // namespace

std::uint64_t noise_identity(const std::string& stream) {
  return hash_combine(kSharedStream, stream);
}

std::uint64_t noise_identity(const std::string& text, const Trajectory& poses) {
  std::uint64_t out = hash_combine(kOwnStream, text);
  for (const auto& [stamp, pose] : poses) {
    const Vector3& t = pose.translation;
    const Rotation& q = pose.rotation;
    for (const double value : {stamp, t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z()}) {
      out = hash_combine(out, std::bit_cast<std::uint64_t>(value));
    }
  }
  return out;
}

}  // namespace loopbench
