/// Permutations of axes with signs.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "datasets/core/se3.hpp"

namespace loopbench::metrics {

/// The 47 signed permutations of three axes but the identity; 24 of all 48 are rotations.
inline const std::vector<Matrix3>& signed_axes() {
  static const std::vector<Matrix3> all = [] {
    std::vector<Matrix3> out;
    std::array<int, 3> order{0, 1, 2};
    do {
      for (int signs = 0; signs < 8; ++signs) {
        Matrix3 axes = Matrix3::Zero();
        for (int row = 0; row < 3; ++row) {
          axes(row, order[static_cast<std::size_t>(row)]) = (signs >> row & 1) != 0 ? -1.0 : 1.0;
        }
        if (axes != Matrix3::Identity()) out.push_back(axes);
      }
    } while (std::ranges::next_permutation(order).found);
    return out;
  }();
  return all;
}

/// Source axis of each axis: "x,-y,z".
inline std::string axes_option(const Matrix3& axes) {
  std::string out;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      if (axes(row, column) == 0.0) continue;
      out += std::string(out.empty() ? "" : ",") + (axes(row, column) < 0.0 ? "-" : "") +
             "xyz"[column];
    }
  }
  return out;
}

}  // namespace loopbench::metrics
