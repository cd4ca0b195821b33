/// Factorisations of small matrices, compiled once in factorisations.cpp instead of in every source
/// that uses them.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "datasets/core/se3.hpp"

namespace loopbench {

/// Inverse by LU with partial pivoting; up to 4 x 4 by cofactors.
Matrix3 inverse_of(const Matrix3& matrix);
Eigen::Matrix4d inverse_of(const Eigen::Matrix4d& matrix);
Matrix6 inverse_of(const Matrix6& matrix);
Eigen::Matrix<double, 7, 7> inverse_of(const Eigen::Matrix<double, 7, 7>& matrix);

}  // namespace loopbench

namespace Eigen {

extern template LLT<Matrix3d>& LLT<Matrix3d>::compute(const EigenBase<Matrix3d>&);
extern template LLT<loopbench::Matrix6>& LLT<loopbench::Matrix6>::compute(
    const EigenBase<loopbench::Matrix6>&);
extern template LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
extern template LLT<Ref<MatrixXd>>& LLT<Ref<MatrixXd>>::compute(const EigenBase<MatrixXd>&);
extern template LDLT<loopbench::Matrix6>& LDLT<loopbench::Matrix6>::compute(
    const EigenBase<loopbench::Matrix6>&);
extern template void LDLT<loopbench::Matrix6>::_solve_impl_transposed<true>(
    const loopbench::Twist&, loopbench::Twist&) const;
extern template SelfAdjointEigenSolver<loopbench::Matrix6>&
SelfAdjointEigenSolver<loopbench::Matrix6>::compute(const EigenBase<loopbench::Matrix6>&, int);

}  // namespace Eigen
