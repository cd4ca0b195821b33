/// Dense kernels of BlockCholesky. A panel is a column-major matrix of `rows` x `columns` blocks of
/// D x D, whose first rows are the triangle of its own columns.
#pragma once

#include <Eigen/Cholesky>
#include <cmath>

namespace loopbench::methods {

using ConstPanel = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
using DensePanel = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

inline DensePanel dense_panel(double* begin,
                              Eigen::Index rows,
                              Eigen::Index columns,
                              Eigen::Index stride) {
  return {begin, rows, columns, Eigen::OuterStride<>(stride)};
}
/// Subtracts from entries begin .. end of a column the product of D columns of L with row `begin`
/// of these columns.
template <int D>
void subtract(double* __restrict column,
              const double* __restrict L,
              Eigen::Index stride,
              Eigen::Index begin,
              Eigen::Index end) {
  double weights[D];
  for (int d = 0; d < D; ++d) weights[d] = L[begin + d * stride];
  for (Eigen::Index r = begin; r < end; ++r) {
    double sum = L[r] * weights[0];
    for (int d = 1; d < D; ++d) sum += L[r + d * stride] * weights[d];
    column[r] -= sum;
  }
}

/// Solves L y = x of a panel in place, and subtracts its rows below from `below`.
inline void solve_forward(const double* L,
                          Eigen::Index width,
                          Eigen::Index height,
                          double* __restrict x,
                          double* __restrict below) {
  for (Eigen::Index c = 0; c < width; ++c, L += height) {
    const double value = x[c] /= L[c];
    for (Eigen::Index r = c + 1; r < width; ++r) x[r] -= L[r] * value;
    for (Eigen::Index r = width; r < height; ++r) below[r - width] -= L[r] * value;
  }
}

/// Solves L' x = y - B' below of a panel in place, where B are its rows below.
inline void solve_backward(const double* L,
                           Eigen::Index width,
                           Eigen::Index height,
                           double* __restrict x,
                           const double* __restrict below) {
  using Vector = Eigen::Map<const Eigen::VectorXd>;
  for (Eigen::Index c = width; c-- > 0;) {
    const double* column = L + c * height;
    const double sum = Vector(column + width, height - width).dot(Vector(below, height - width)) +
                       Vector(column + c + 1, width - c - 1).dot(Vector(x + c + 1, width - c - 1));
    x[c] = (x[c] - sum) / column[c];
  }
}

/// Replaces the panel by its columns of the factor; false: not positive definite to rounding.
template <int D>
bool eliminate_panel(double* panel, int columns, int rows) {
  constexpr Eigen::Index kWide = 48;  // from here on Eigen's blocked kernels are faster
  const Eigen::Index height = rows * D;
  const Eigen::Index width = columns * D;
  if (width >= kWide) {
    DensePanel top = dense_panel(panel, width, width, height);
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(top);
    if (factor.info() != Eigen::Success) return false;
    DensePanel below = dense_panel(panel + width, height - width, width, height);
    top.triangularView<Eigen::Lower>().transpose().template solveInPlace<Eigen::OnTheRight>(below);
    return true;
  }
  for (Eigen::Index begin = 0; begin < width; begin += D) {
    double* block = panel + begin * height;
    for (Eigen::Index c = begin; c < begin + D; ++c) {
      double* column = panel + c * height;
      const double pivot = column[c];
      if (!(pivot > 0.0)) return false;
      const double root = std::sqrt(pivot);
      const double inverse = 1.0 / root;
      column[c] = root;
      for (Eigen::Index r = c + 1; r < height; ++r) column[r] *= inverse;
      for (Eigen::Index next = c + 1; next < begin + D; ++next) {
        subtract<1>(panel + next * height, column, height, next, height);
      }
    }
    for (Eigen::Index next = begin + D; next < width; ++next) {
      subtract<D>(panel + next * height, block, height, next, height);
    }
  }
  return true;
}

/// Subtracts the product of the rows below with their transpose from the lower triangle of
/// `update`.
template <int D>
void subtract_products(double* update, const double* panel, int columns, int rows) {
  constexpr Eigen::Index kLarge = 96;  // from here on Eigen's blocked kernel is faster
  const Eigen::Index height = rows * D;
  const Eigen::Index width = columns * D;
  const Eigen::Index side = height - width;
  if (side + width >= kLarge) {
    dense_panel(update, side, side, side)
        .template selfadjointView<Eigen::Lower>()
        .rankUpdate(ConstPanel(panel + width, side, width, Eigen::OuterStride<>(height)), -1.0);
    return;
  }
  for (Eigen::Index column = 0; column < side; ++column) {
    for (Eigen::Index c = 0; c < width; c += D) {
      subtract<D>(update + column * side, panel + width + c * height, height, column, side);
    }
  }
}

}  // namespace loopbench::methods
