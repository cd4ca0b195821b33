/// Solver for (block) tridiagonal linear systems.
#pragma once

#include <Eigen/LU>
#include <cstddef>
#include <vector>

#include "datasets/core/so3.hpp"

namespace loopbench {

/// Row i of the system: lower * x[i - 1] + diagonal * x[i] + upper * x[i + 1] = right.
/// `Block` is double or Matrix3, `Value` the type of x[i].
template <class Block, class Value>
struct TridiagonalRow {
  Block lower;
  Block diagonal;
  Block upper;
  Value right;
};

inline double inverse(double block) { return 1.0 / block; }
inline Matrix3 inverse(const Matrix3& block) { return block.inverse(); }

/// Solves the system by elimination without pivoting, which is backward stable for the matrices
/// used here: totally positive ones of B-spline interpolation (de Boor & Pinkus 1977) and
/// diagonally dominant ones. Overwrites `rows`. O(n).
template <class Block, class Value>
std::vector<Value> solve_tridiagonal(std::vector<TridiagonalRow<Block, Value>>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    auto& row = rows[i];
    if (i > 0) {
      row.diagonal -= row.lower * rows[i - 1].upper;
      row.right -= row.lower * rows[i - 1].right;
    }
    const Block pivot = inverse(row.diagonal);
    row.upper = pivot * row.upper;
    row.right = pivot * row.right;
  }
  std::vector<Value> out(rows.size());
  for (std::size_t i = rows.size(); i-- > 0;) {
    out[i] = rows[i].right;
    if (i + 1 < rows.size()) out[i] -= rows[i].upper * out[i + 1];
  }
  return out;
}

}  // namespace loopbench
