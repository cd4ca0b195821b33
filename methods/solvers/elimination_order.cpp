#include "methods/solvers/elimination_order.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <numeric>

namespace loopbench::methods {

std::vector<std::size_t> elimination_order(const std::vector<std::size_t>& poses,
                                           const std::vector<std::vector<std::size_t>>& cliques) {
  // Among poses of equal degree, Eigen eliminates the one with the largest index first: the poses
  // are numbered from the newest to the oldest. Placeholders raise the degree of the newest one:
  // otherwise the end of a chain would be eliminated as early as its begin.
  constexpr int kPlaceholders = 12;
  const auto n = static_cast<int>(poses.size());
  if (n == 0) return {};
  std::vector<Eigen::Triplet<double>> entries;
  const auto connect = [&](const std::vector<int>& members) {
    for (const int row : members) {
      for (const int column : members) entries.emplace_back(row, column, 1.0);
    }
  };
  std::vector<int> members(kPlaceholders + 1);  // the newest pose has the index after them
  std::iota(members.begin(), members.end(), 0);
  connect(members);
  const auto index_of = [&](std::size_t pose) {
    const auto found = std::ranges::lower_bound(poses, pose);
    if (found == poses.end() || *found != pose) return -1;
    return kPlaceholders + n - 1 - static_cast<int>(found - poses.begin());
  };
  for (const std::vector<std::size_t>& clique : cliques) {
    members.clear();
    for (const std::size_t pose : clique) {
      if (const int index = index_of(pose); index >= 0) members.push_back(index);
    }
    connect(members);
  }
  Eigen::SparseMatrix<double> pattern(kPlaceholders + n, kPlaceholders + n);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::AMDOrdering<int>::PermutationType order;
  Eigen::AMDOrdering<int>()(pattern, order);
  std::vector<std::size_t> out;
  for (Eigen::Index k = 0; k < order.size(); ++k) {
    const int i = order.indices()[k];
    if (i > kPlaceholders)
      out.push_back(poses[static_cast<std::size_t>(kPlaceholders + n - 1 - i)]);
  }
  out.push_back(poses.back());
  return out;
}

}  // namespace loopbench::methods
