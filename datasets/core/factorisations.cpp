#include "datasets/core/factorisations.hpp"

namespace loopbench {

Matrix3 inverse_of(const Matrix3& matrix) { return matrix.inverse(); }

Eigen::Matrix4d inverse_of(const Eigen::Matrix4d& matrix) { return matrix.inverse(); }

Matrix6 inverse_of(const Matrix6& matrix) { return matrix.inverse(); }

Eigen::Matrix<double, 7, 7> inverse_of(const Eigen::Matrix<double, 7, 7>& matrix) {
  return matrix.inverse();
}

}  // namespace loopbench

namespace Eigen {

template LLT<Matrix3d>& LLT<Matrix3d>::compute(const EigenBase<Matrix3d>&);
template LLT<loopbench::Matrix6>& LLT<loopbench::Matrix6>::compute(
    const EigenBase<loopbench::Matrix6>&);
template LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
template LLT<Ref<MatrixXd>>& LLT<Ref<MatrixXd>>::compute(const EigenBase<MatrixXd>&);
template LDLT<loopbench::Matrix6>& LDLT<loopbench::Matrix6>::compute(
    const EigenBase<loopbench::Matrix6>&);
template void LDLT<loopbench::Matrix6>::_solve_impl_transposed<true>(const loopbench::Twist&,
                                                                     loopbench::Twist&) const;
template SelfAdjointEigenSolver<loopbench::Matrix6>&
SelfAdjointEigenSolver<loopbench::Matrix6>::compute(const EigenBase<loopbench::Matrix6>&, int);

}  // namespace Eigen
