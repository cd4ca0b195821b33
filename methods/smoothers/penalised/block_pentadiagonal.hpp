/// Symmetric positive definite block systems with two diagonals of 3 x 3 blocks on each side.
#pragma once

#include <Eigen/LU>
#include <vector>

#include "methods/smoothers/penalised/pentadiagonal.hpp"

namespace loopbench::methods {

/// Solves (B + blocks) x = right in place. Scalars of B are multiples of the identity; `blocks` are
/// added to the diagonal and are overwritten. Block elimination; each pivot is symmetrised, because
/// otherwise the asymmetry due to rounding grows from pivot to pivot. O(n).
inline void solve_block_pentadiagonal(const Pentadiagonal& B,
                                      std::vector<Eigen::Matrix3d>& blocks,
                                      std::vector<Eigen::Vector3d>& right) {
  using Block = Eigen::Matrix3d;
  const std::size_t n = B.size();
  const auto symmetric = [](const Block& M) -> Block { return 0.5 * (M + M.transpose()); };
  std::vector<Block> factor(n);                // first subdiagonal of L
  Block next = B[0].next * Block::Identity();  // block (i + 1, i)
  for (std::size_t i = 0; i < n; ++i) {
    const Block pivot = blocks[i] + B[i].diagonal * Block::Identity();
    const Block inverse = symmetric(symmetric(pivot).inverse());
    blocks[i] = inverse;
    if (i + 1 == n) break;
    factor[i] = next * inverse;
    blocks[i + 1] -= factor[i] * next.transpose();
    right[i + 1] -= factor[i] * right[i];
    if (i + 2 == n) continue;
    const double second = B[i].second;
    blocks[i + 2] -= second * second * inverse;
    right[i + 2] -= second * (inverse * right[i]);
    next = B[i + 1].next * Block::Identity() - second * factor[i].transpose();
  }
  for (std::size_t i = n; i-- > 0;) {
    Eigen::Vector3d x = right[i];
    if (i + 2 < n) x -= B[i].second * right[i + 2];
    x = (blocks[i] * x).eval();
    if (i + 1 < n) x -= factor[i].transpose() * right[i + 1];
    right[i] = x;
  }
}

/// Returns B x, where scalars of B are multiples of the identity. O(n).
inline std::vector<Eigen::Vector3d> block_product(const Pentadiagonal& B,
                                                  const std::vector<Eigen::Vector3d>& x) {
  std::vector<Eigen::Vector3d> out(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) out[i] = B[i].diagonal * x[i];
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    out[i] += B[i].next * x[i + 1];
    out[i + 1] += B[i].next * x[i];
    if (i + 2 == x.size()) break;
    out[i] += B[i].second * x[i + 2];
    out[i + 2] += B[i].second * x[i];
  }
  return out;
}

}  // namespace loopbench::methods
