/// Diagonal blocks of the inverse of a sparse matrix, without its other entries.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

namespace loopbench::methods {

/// Returns the blocks on the diagonal of the inverse of a symmetric positive definite matrix, each
/// `block` x `block`. `lower` is its lower triangle in complete blocks: every stored block has all
/// entries, zeros included, except above the diagonal.
///
/// The entries of the inverse on the pattern of the Cholesky factor (block ordering by approximate
/// minimum degree) are computed from the last column to the first, because each depends only on
/// entries of later columns on this pattern. Time and memory are those of the factorisation, up to
/// a constant. Throws std::runtime_error if the matrix is not positive definite. Deterministic.
///
/// Source: K. Takahashi, J. Fagan, M.-S. Chin, Formation of a sparse bus impedance matrix, 1973;
/// A. M. Erisman, W. F. Tinney, On computing certain elements of the inverse of a sparse matrix,
/// CACM 18(3), 1975.
std::vector<Eigen::MatrixXd> inverse_diagonal_blocks(const Eigen::SparseMatrix<double>& lower,
                                                     Eigen::Index block);

}  // namespace loopbench::methods
