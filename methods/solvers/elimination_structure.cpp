#include "methods/solvers/elimination_structure.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

namespace loopbench::methods {
namespace {

auto at(int i) { return static_cast<std::size_t>(i); }

/// Lists of numbers, one after the other in memory.
class Lists {
 public:
  Lists() = default;

  /// Groups of the second numbers by the first, which are below `count`, in the order of the pairs.
  Lists(std::size_t count, const std::vector<std::pair<int, int>>& pairs)
      : begin_(count + 1, 0), items_(pairs.size()) {
    for (const auto& [group, item] : pairs) ++begin_[at(group) + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (const auto& [group, item] : pairs) items_[next[at(group)]++] = item;
  }

  void push_back(const std::vector<int>& list) {
    items_.insert(items_.end(), list.begin(), list.end());
    begin_.push_back(items_.size());
  }
  int size() const { return static_cast<int>(begin_.size()) - 1; }
  std::span<int> operator[](int i) {
    return std::span(items_).subspan(begin_[at(i)], begin_[at(i) + 1] - begin_[at(i)]);
  }
  std::span<const int> operator[](int i) const {
    return std::span(items_).subspan(begin_[at(i)], begin_[at(i) + 1] - begin_[at(i)]);
  }

 private:
  std::vector<std::size_t> begin_{0};
  std::vector<int> items_;
};

/// Rows below the diagonal of each column of the factor, ascending: those of the matrix, and those
/// of the columns whose first row it is.
Lists columns_of_factor(const std::vector<int>& position,
                        const std::vector<std::pair<int, int>>& pairs) {
  std::vector<std::pair<int, int>> entries;
  entries.reserve(pairs.size());
  for (const auto& [i, j] : pairs) {
    const auto [first, second] = std::minmax(position[at(i)], position[at(j)]);
    if (first != second) entries.emplace_back(first, second);
  }
  const Lists of_matrix(position.size(), entries);
  Lists out;
  std::vector<int> last_child(position.size(), -1);
  std::vector<int> sibling(position.size(), -1);  // the child of the same column before
  std::vector<int> seen(position.size(), -1);
  std::vector<int> merged;
  for (int j = 0; j < of_matrix.size(); ++j) {
    merged.clear();
    seen[at(j)] = j;
    const auto add = [&](std::span<const int> rows) {
      for (const int row : rows) {
        if (std::exchange(seen[at(row)], j) != j) merged.push_back(row);
      }
    };
    add(of_matrix[j]);
    for (int child = last_child[at(j)]; child >= 0; child = sibling[at(child)]) {
      add(std::as_const(out)[child]);
    }
    std::ranges::sort(merged);
    out.push_back(merged);
    if (!merged.empty()) sibling[at(j)] = std::exchange(last_child[at(merged.front())], j);
  }
  return out;
}

/// Position of each column in a postorder of the elimination tree, the largest child last.
std::vector<int> postorder(const Lists& columns) {
  std::vector<int> stack;
  std::vector<std::pair<int, int>> parents;
  parents.reserve(at(columns.size()));
  for (int j = 0; j < columns.size(); ++j) {
    if (columns[j].empty()) {
      stack.push_back(j);
    } else {
      parents.emplace_back(columns[j].front(), j);
    }
  }
  Lists children(at(columns.size()), parents);
  // A column is placed before its descendants, from the end of the order.
  std::vector<int> out(at(columns.size()));
  int next = columns.size();
  while (!stack.empty()) {
    const int j = stack.back();
    stack.pop_back();
    out[at(j)] = --next;
    const std::span<int> below = children[j];
    std::ranges::stable_sort(below, {}, [&](int child) { return columns[child].size(); });
    stack.insert(stack.end(), below.begin(), below.end());
  }
  return out;
}

/// Whether a supernode of so many columns and rows is stored with so many of its blocks zero.
bool is_dense_enough(int columns, double zeros) {
  if (columns <= 4) return zeros < 0.15;
  return zeros < (columns <= 16 ? 0.1 : 0.05);
}

}  // namespace

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

EliminationStructure::EliminationStructure(int blocks,
                                           const std::vector<std::pair<int, int>>& pairs)
    : position_(minimum_degree(blocks, pairs)), owner_(position_.size()) {
  const Lists columns = columns_of_factor(position_, pairs);
  const std::vector<int> order = postorder(columns);
  std::vector<int> column_at(order.size());  // at a position of the order
  for (int j = 0; j < blocks; ++j) column_at[at(order[at(j)])] = j;
  for (int& position : position_) position = order[at(position)];
  const auto rows_at = [&](int position) { return columns[column_at[at(position)]]; };

  double entries = 0.0;
  for (int j = 0; j < blocks; ++j) {
    const auto own = static_cast<double>(rows_at(j).size()) + 1.0;
    if (j > 0 && !rows_at(j - 1).empty() && order[at(rows_at(j - 1).front())] == j) {
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
    const std::span<const int> rows = rows_at(node.end - 1);
    node.offset = rows_.size();
    node.below = static_cast<int>(rows.size());
    for (const int row : rows) rows_.push_back(order[at(row)]);
    std::sort(rows_.end() - node.below, rows_.end());
  }
  for (Supernode& node : supernodes_) {
    if (node.below > 0) node.parent = supernode_of(rows_[node.offset]);
  }
}

int EliminationStructure::row_in(const Supernode& in, int column) const {
  if (column < in.end) return column - in.first;
  const int* begin = rows_below(in);
  return in.columns() + static_cast<int>(std::lower_bound(begin, begin + in.below, column) - begin);
}

}  // namespace loopbench::methods
