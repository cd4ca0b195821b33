#include "metrics/numerics/moments.hpp"

#include <algorithm>
#include <vector>

#include "datasets/core/parallel.hpp"

namespace loopbench::metrics {
namespace {

// 256 pairs are 32 kB: read twice, loaded into the cache once.
constexpr std::size_t kBlock = 256;

Moments block_moments(const Trajectory& reference,
                      const Trajectory& estimate,
                      std::size_t begin,
                      std::size_t end) {
  // Relative to the block's first point, so that equal points give exactly zero variance.
  const Vector3 p0 = reference[begin].world_from_body.translation;
  const Vector3 q0 = estimate[begin].world_from_body.translation;
  Moments out;
  out.count = static_cast<double>(end - begin);
  Vector3 p_sum = Vector3::Zero();
  Vector3 q_sum = Vector3::Zero();
  for (std::size_t i = begin; i < end; ++i) {
    p_sum += reference[i].world_from_body.translation - p0;
    q_sum += estimate[i].world_from_body.translation - q0;
  }
  const Vector3 p_mean = p_sum / out.count;
  const Vector3 q_mean = q_sum / out.count;
  for (std::size_t i = begin; i < end; ++i) {
    const Vector3 p = reference[i].world_from_body.translation - p0 - p_mean;
    const Vector3 q = estimate[i].world_from_body.translation - q0 - q_mean;
    out.reference_dispersion += p.squaredNorm();
    out.estimate_dispersion += q.squaredNorm();
    out.cross.noalias() += p * q.transpose();
  }
  out.reference_mean = p0 + p_mean;
  out.estimate_mean = q0 + q_mean;
  return out;
}

Moments merged(const Moments& a, const Moments& b) {
  const Vector3 p = b.reference_mean - a.reference_mean;
  const Vector3 q = b.estimate_mean - a.estimate_mean;
  Moments out;
  out.count = a.count + b.count;
  const double share = b.count / out.count;
  const double weight = a.count * share;
  out.reference_mean = a.reference_mean + share * p;
  out.estimate_mean = a.estimate_mean + share * q;
  out.reference_dispersion =
      a.reference_dispersion + b.reference_dispersion + weight * p.squaredNorm();
  out.estimate_dispersion =
      a.estimate_dispersion + b.estimate_dispersion + weight * q.squaredNorm();
  out.cross = a.cross + b.cross + weight * p * q.transpose();
  return out;
}

}  // namespace

Moments moments(const Trajectory& reference, const Trajectory& estimate) {
  if (reference.empty()) return {};
  std::vector<Moments> blocks((reference.size() + kBlock - 1) / kBlock);
  parallel_for_blocks(reference.size(), [&](std::size_t first, std::size_t last) {
    // A block is processed by the thread that has its first pair.
    for (std::size_t k = (first + kBlock - 1) / kBlock; k * kBlock < last; ++k) {
      const std::size_t end = std::min((k + 1) * kBlock, reference.size());
      blocks[k] = block_moments(reference, estimate, k * kBlock, end);
    }
  });
  Moments out = blocks.front();
  for (std::size_t k = 1; k < blocks.size(); ++k) out = merged(out, blocks[k]);
  return out;
}

}  // namespace loopbench::metrics
