/// Factorisations of small matrices, compiled once in factorisations.cpp instead of in every source
/// that uses them.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "datasets/core/se3.hpp"

namespace loopbench {

/// Inverse by LU with partial pivoting.
Matrix6 inverse_of(const Matrix6& matrix);

}  // namespace loopbench

namespace Eigen {

extern template LLT<Matrix3d>& LLT<Matrix3d>::compute(const EigenBase<Matrix3d>&);
extern template LLT<loopbench::Matrix6>& LLT<loopbench::Matrix6>::compute(
    const EigenBase<loopbench::Matrix6>&);
extern template LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
extern template LDLT<loopbench::Matrix6>& LDLT<loopbench::Matrix6>::compute(
    const EigenBase<loopbench::Matrix6>&);
extern template void LDLT<loopbench::Matrix6>::_solve_impl_transposed<true>(
    const loopbench::Twist&, loopbench::Twist&) const;

}  // namespace Eigen
