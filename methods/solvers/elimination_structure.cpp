#include "methods/solvers/elimination_structure.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <utility>

namespace loopbench::methods {
namespace {

using Lists = std::vector<std::vector<int>>;

auto at(int i) { return static_cast<std::size_t>(i); }

/// Returns for each block its place in the order of elimination.
std::vector<int> minimum_degree(int blocks, const std::vector<std::pair<int, int>>& pairs) {
  std::vector<Eigen::Triplet<char>> entries;
  entries.reserve(pairs.size() + at(blocks));
  for (int i = 0; i < blocks; ++i) entries.emplace_back(i, i, 1);
  for (const auto& [i, j] : pairs) entries.emplace_back(std::max(i, j), std::min(i, j), 1);
  Eigen::SparseMatrix<char> pattern(blocks, blocks);
  pattern.setFromTriplets(entries.begin(), entries.end(), [](char, char) -> char { return 1; });
  Eigen::AMDOrdering<int>::PermutationType order;
  Eigen::AMDOrdering<int>()(pattern.selfadjointView<Eigen::Lower>(), order);
  std::vector<int> out(at(blocks));
  for (int k = 0; k < blocks; ++k) out[at(order.indices()[k])] = k;
  return out;
}

/// Rows below the diagonal of each column of the factor, ascending: those of the matrix, and those
/// of the columns whose first row it is.
Lists columns_of_factor(const std::vector<int>& position,
                        const std::vector<std::pair<int, int>>& pairs) {
  Lists out(position.size());
  for (const auto& [i, j] : pairs) {
    const auto [first, second] = std::minmax(position[at(i)], position[at(j)]);
    if (first != second) out[at(first)].push_back(second);
  }
  Lists children(position.size());
  std::vector<int> seen(position.size(), -1);
  std::vector<int> merged;
  for (int j = 0; j < static_cast<int>(out.size()); ++j) {
    merged.clear();
    seen[at(j)] = j;
    const auto add = [&](const std::vector<int>& rows) {
      for (const int row : rows) {
        if (std::exchange(seen[at(row)], j) != j) merged.push_back(row);
      }
    };
    add(out[at(j)]);
    for (const int child : children[at(j)]) add(out[at(child)]);
    std::ranges::sort(merged);
    out[at(j)] = merged;
    if (!merged.empty()) children[at(merged.front())].push_back(j);
  }
  return out;
}

/// Place of each column in a postorder of the elimination tree, the largest child last.
std::vector<int> postorder(const Lists& columns) {
  Lists children(columns.size());
  std::vector<int> stack;
  for (int j = 0; j < static_cast<int>(columns.size()); ++j) {
    const std::vector<int>& rows = columns[at(j)];
    (rows.empty() ? stack : children[at(rows.front())]).push_back(j);
  }
  for (std::vector<int>& each : children) {
    std::ranges::stable_sort(each, {}, [&](int child) { return columns[at(child)].size(); });
  }
  // A column is placed before its descendants, from the end of the order.
  std::vector<int> out(columns.size());
  int next = static_cast<int>(columns.size());
  while (!stack.empty()) {
    const int j = stack.back();
    stack.pop_back();
    out[at(j)] = --next;
    stack.insert(stack.end(), children[at(j)].begin(), children[at(j)].end());
  }
  return out;
}

/// Whether a supernode of so many columns and rows is stored with so many of its blocks zero.
bool is_dense_enough(int columns, double zeros) {
  if (columns <= 4) return zeros < 0.5;
  return zeros < (columns <= 16 ? 0.2 : 0.05);
}

}  // namespace

EliminationStructure::EliminationStructure(int blocks,
                                           const std::vector<std::pair<int, int>>& pairs)
    : EliminationStructure(minimum_degree(blocks, pairs), pairs) {}

EliminationStructure::EliminationStructure(std::vector<int> position,
                                           const std::vector<std::pair<int, int>>& pairs)
    : position_(std::move(position)), owner_(position_.size()) {
  Lists unordered = columns_of_factor(position_, pairs);
  const std::vector<int> order = postorder(unordered);
  for (int& position : position_) position = order[at(position)];
  Lists columns(unordered.size());
  for (std::size_t j = 0; j < unordered.size(); ++j) {
    std::vector<int>& rows = columns[at(order[j])] = std::move(unordered[j]);
    for (int& row : rows) row = order[at(row)];
    std::ranges::sort(rows);
  }

  double entries = 0.0;
  for (int j = 0; j < blocks(); ++j) {
    const std::vector<int>& rows = columns[at(j)];
    const auto own = static_cast<double>(rows.size()) + 1.0;
    if (j > 0 && !columns[at(j - 1)].empty() && columns[at(j - 1)].front() == j) {
      Supernode& last = supernodes_.back();
      const int width = j + 1 - last.first;
      const double stored = width * (0.5 * (width - 1) + own);
      if (is_dense_enough(width, 1.0 - (entries + own) / stored)) {
        entries += own;
        last.end = j + 1;
        continue;
      }
    }
    entries = own;
    supernodes_.push_back({.first = j, .end = j + 1});
  }
  for (int s = 0; s < static_cast<int>(supernodes_.size()); ++s) {
    Supernode& node = supernodes_[at(s)];
    std::fill(owner_.begin() + node.first, owner_.begin() + node.end, s);
    const std::vector<int>& rows = columns[at(node.end - 1)];
    node.offset = rows_.size();
    node.below = static_cast<int>(rows.size());
    rows_.insert(rows_.end(), rows.begin(), rows.end());
  }
  for (Supernode& node : supernodes_) {
    if (node.below > 0) node.parent = supernode_of(rows_[node.offset]);
  }
}

double EliminationStructure::work() const {
  double sum = 0.0;
  for (const Supernode& node : supernodes_) {
    for (int height = node.rows(); height > node.below; --height) sum += double(height) * height;
  }
  return sum;
}

int EliminationStructure::row_in(const Supernode& in, int column) const {
  if (column < in.end) return column - in.first;
  const int* begin = rows_below(in);
  return in.columns() + static_cast<int>(std::lower_bound(begin, begin + in.below, column) - begin);
}

}  // namespace loopbench::methods
