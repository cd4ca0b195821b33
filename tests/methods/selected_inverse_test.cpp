#include "methods/solvers/selected_inverse.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

namespace loopbench::selected_inverse_test {

using namespace methods;

namespace {

TEST(SelectedInverse, EqualsTheDenseInverse) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (const Eigen::Index block : {1, 2, 3, 6}) {
    for (const Eigen::Index blocks : {1, 2, 25}) {
      Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(blocks * block, blocks * block);
      Eigen::MatrixXd stored = Eigen::MatrixXd::Zero(blocks * block, blocks * block);
      const auto add = [&](Eigen::Index i, Eigen::Index j) {  // the information of one edge
        Eigen::MatrixXd J = Eigen::MatrixXd::Zero(block, blocks * block);
        for (const Eigen::Index k : {i, j}) {
          for (double& each : J.middleCols(k * block, block).reshaped()) each = normal(random);
        }
        matrix += J.transpose() * J;
      };
      for (Eigen::Index i = 0; i + 1 < blocks; ++i) add(i, i + 1);
      for (int k = 0; k < 12 && blocks > 2; ++k) {
        add(static_cast<Eigen::Index>(random() % 25), static_cast<Eigen::Index>(random() % 25));
      }
      std::vector<Eigen::Triplet<double>> entries;
      for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
        for (Eigen::Index i = j; i < matrix.rows(); ++i) {
          const auto part = matrix.block(i / block * block, j / block * block, block, block);
          if (part.isZero(0.0)) continue;
          entries.emplace_back(static_cast<int>(i), static_cast<int>(j), matrix(i, j));
        }
      }
      Eigen::SparseMatrix<double> lower(matrix.rows(), matrix.cols());
      lower.setFromTriplets(entries.begin(), entries.end());
      const Eigen::MatrixXd inverse = matrix.inverse();
      const auto found = inverse_diagonal_blocks(lower, block);
      ASSERT_EQ(found.size(), static_cast<std::size_t>(blocks));
      for (Eigen::Index i = 0; i < blocks; ++i) {
        const auto expected = inverse.block(i * block, i * block, block, block);
        EXPECT_TRUE(found[static_cast<std::size_t>(i)].isApprox(expected, 1e-10)) << block << i;
      }
    }
  }
}

}  // namespace
}  // namespace loopbench::selected_inverse_test
