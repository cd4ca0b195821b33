#include "datasets/core/factorisations.hpp"

namespace loopbench {

Matrix6 inverse_of(const Matrix6& matrix) { return matrix.inverse(); }

}  // namespace loopbench

namespace Eigen {

template LLT<Matrix3d>& LLT<Matrix3d>::compute(const EigenBase<Matrix3d>&);
template LLT<loopbench::Matrix6>& LLT<loopbench::Matrix6>::compute(
    const EigenBase<loopbench::Matrix6>&);
template LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
template LDLT<loopbench::Matrix6>& LDLT<loopbench::Matrix6>::compute(
    const EigenBase<loopbench::Matrix6>&);
template void LDLT<loopbench::Matrix6>::_solve_impl_transposed<true>(const loopbench::Twist&,
                                                                     loopbench::Twist&) const;

}  // namespace Eigen
