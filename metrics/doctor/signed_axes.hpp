/// Permutations of axes with signs.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "datasets/core/se3.hpp"

namespace loopbench::metrics {

struct SignedAxes {
  Matrix3 matrix = Matrix3::Zero();
  std::string option;  ///< source axis of each axis: "x,-y,z"
};

/// The 47 signed permutations of three axes but the identity; 24 of all 48 are rotations.
inline std::vector<SignedAxes> signed_axes() {
  std::vector<SignedAxes> out;
  std::array<int, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      SignedAxes axes;
      for (int row = 0; row < 3; ++row) {
        const bool is_negative = (signs >> row & 1) != 0;
        const int column = order[static_cast<std::size_t>(row)];
        axes.matrix(row, column) = is_negative ? -1.0 : 1.0;
        axes.option += std::string(row == 0 ? "" : ",") + (is_negative ? "-" : "") + "xyz"[column];
      }
      if (axes.matrix != Matrix3::Identity()) out.push_back(std::move(axes));
    }
  } while (std::ranges::next_permutation(order).found);
  return out;
}

}  // namespace loopbench::metrics
