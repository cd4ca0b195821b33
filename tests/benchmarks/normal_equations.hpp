/// The sparse normal equations of a pose graph, as a comparison for solvers.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "methods/method.hpp"
#include "methods/solvers/groups/se2.hpp"
#include "methods/solvers/groups/se3.hpp"
#include "methods/solvers/residuals.hpp"

namespace loopbench::test {

using Sparse = Eigen::SparseMatrix<double>;

/// J' Omega J at the keyframes, with the first one fixed.
template <class G>
Sparse normal_equations_of(const Problem& problem) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto element = [&](std::size_t i) {
    const Pose& first = problem.keyframes[0].world_from_body;
    return G::from({first.inverse() * problem.keyframes[i].world_from_body, 1.0});
  };
  for (const std::vector<Edge>* edges : {&problem.odometry, &problem.closures}) {
    for (const Edge& edge : *edges) {
      const auto at = methods::edge_residual<G>(
          G::inverse(G::from(methods::measured(edge))), element(edge.from), element(edge.to));
      const auto W = G::information(edge, 1.0);
      const std::size_t ends[] = {edge.from, edge.to};
      const typename G::Square* J[] = {&at.by_from, &at.by_to};
      for (int a = 0; a < 2; ++a) {
        for (int b = 0; b < 2; ++b) {
          if (ends[a] == 0 || ends[b] == 0) continue;
          const typename G::Square block = J[a]->transpose() * W * *J[b];
          const auto row = static_cast<int>(ends[a] - 1) * G::kDof;
          const auto column = static_cast<int>(ends[b] - 1) * G::kDof;
          for (int r = 0; r < G::kDof; ++r) {
            for (int c = 0; c < G::kDof; ++c)
              entries.emplace_back(row + r, column + c, block(r, c));
          }
        }
      }
    }
  }
  const auto size = static_cast<Eigen::Index>(problem.keyframes.size() - 1) * G::kDof;
  Sparse H(size, size);
  H.setFromTriplets(entries.begin(), entries.end());
  return H;
}

inline Sparse normal_equations(const Problem& problem) {
  return problem.planar ? normal_equations_of<methods::Se2>(problem)
                        : normal_equations_of<methods::Se3>(problem);
}

}  // namespace loopbench::test
