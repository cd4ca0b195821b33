#include "methods/solvers/elimination_tree.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <utility>

#include "methods/solvers/elimination_order.hpp"

namespace loopbench::methods {

template <int D>
void EliminationTree<D>::add_pose() {
  nodes_.emplace_back();
  is_marked_.push_back(0);
  slot_.push_back(-1);
}

template <int D>
std::vector<std::size_t> EliminationTree<D>::affected_by(const std::vector<std::size_t>& touched) {
  std::vector<std::size_t> out;
  for (std::size_t pose : touched) {
    const auto begin = static_cast<std::ptrdiff_t>(out.size());
    for (; pose != kNone && pose != 0 && is_marked_[pose] == 0; pose = nodes_[pose].parent) {
      is_marked_[pose] = 1;
      out.push_back(pose);
    }
    std::reverse(out.begin() + begin, out.end());
  }
  // A path ends below a pose of an earlier one: later paths come first.
  std::ranges::reverse(out);
  return out;
}

template <int D>
std::vector<std::size_t> EliminationTree<D>::ordered(const Graph& graph) const {
  std::vector<std::size_t> affected;
  std::vector<std::vector<std::size_t>> cliques;
  for (std::size_t pose = 0; pose < nodes_.size(); ++pose) {
    if (is_marked_[pose] == 0) continue;
    affected.push_back(pose);
    for (const std::size_t edge : graph.edges_of[pose]) {
      const EdgeEquations<D>& of = graph.equations[edge];
      if (of.from == pose && is_marked_[of.to] != 0) cliques.push_back({of.from, of.to});
    }
    for (const std::size_t child : nodes_[pose].children) {
      if (is_marked_[child] == 0) cliques.push_back(nodes_[child].separator);
    }
  }
  return elimination_order(affected, cliques);
}

template <int D>
void EliminationTree<D>::attach_to_parent(std::size_t pose) {
  Node& node = nodes_[pose];
  const auto rank_of = [&](std::size_t other) { return nodes_[other].rank; };
  const auto first = std::ranges::min_element(node.separator, {}, rank_of);
  node.parent = first == node.separator.end() ? kNone : *first;
  if (node.parent != kNone) nodes_[node.parent].children.push_back(pose);
}

template <int D>
template <class Equations, class Poses>
void EliminationTree<D>::add_equations(Node& node,
                                       const Equations& equations,
                                       const Poses& poses) const {
  // The matrix is symmetric: a block below the diagonal is added to its transpose.
  const auto block = [&](std::size_t i, std::size_t j) {
    return equations.template block<D, D>(static_cast<Eigen::Index>(i) * D,
                                          static_cast<Eigen::Index>(j) * D);
  };
  const Eigen::Index right = equations.cols() - 1;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Index slot = slot_[poses[i]];
    if (slot < 0) continue;  // pose 0
    const Vector value = equations.col(right).template segment<D>(static_cast<Eigen::Index>(i) * D);
    if (slot == 0) {
      node.rows.col(node.rows.cols() - 1) += value;
    } else {
      node.schur.col(node.schur.cols() - 1).template segment<D>((slot - 1) * D) += value;
    }
    for (std::size_t j = i; j < poses.size(); ++j) {
      const Eigen::Index other = slot_[poses[j]];
      if (other < 0) continue;
      const auto [row, column] = std::minmax(slot, other);
      const auto add_to = [&](auto to) {
        if (slot <= other) {
          to += block(i, j);
        } else {
          to += block(i, j).transpose();
        }
      };
      if (row == 0) {
        add_to(node.rows.template middleCols<D>(column * D));
      } else {
        add_to(node.schur.template block<D, D>((row - 1) * D, (column - 1) * D));
      }
    }
  }
}

template <int D>
void EliminationTree<D>::eliminate(std::size_t pose, const Graph& graph) {
  Node& node = nodes_[pose];
  std::vector<std::size_t> front_poses;
  const auto add = [&](std::size_t other) {
    if (other == 0 || slot_[other] >= 0) return;
    slot_[other] = static_cast<Eigen::Index>(front_poses.size());
    front_poses.push_back(other);
  };
  add(pose);
  std::vector<std::size_t> own;  // an edge belongs to the pose that is eliminated first
  for (const std::size_t edge : graph.edges_of[pose]) {
    const EdgeEquations<D>& of = graph.equations[edge];
    const std::size_t other = of.from == pose ? of.to : of.from;
    if (other != 0 && nodes_[other].rank < node.rank) continue;
    own.push_back(edge);
    add(other);
  }
  for (const std::size_t child : node.children) {
    for (const std::size_t other : nodes_[child].separator) add(other);
  }
  const auto rest = static_cast<Eigen::Index>(front_poses.size() - 1) * D;
  node.rows.setZero(D, D + rest + 1);
  node.schur.setZero(rest, rest + 1);
  for (const std::size_t edge : own) {
    const EdgeEquations<D>& of = graph.equations[edge];
    add_equations(node, of.matrix, std::array{of.from, of.to});
  }
  for (const std::size_t child : node.children) {
    add_equations(node, nodes_[child].schur, nodes_[child].separator);
  }
  for (const std::size_t other : front_poses) slot_[other] = -1;

  const Eigen::LLT<Eigen::Matrix<double, D, D>> factor(node.rows.template leftCols<D>());
  if (factor.info() != Eigen::Success) {
    throw std::runtime_error("the normal equations of keyframe " + std::to_string(pose) +
                             " are not positive definite");
  }
  node.rows.template leftCols<D>() = factor.matrixU();
  auto beside = node.rows.rightCols(rest + 1);
  for (Eigen::Index j = 0; j <= rest; ++j) {
    Vector column = beside.col(j);
    factor.matrixL().solveInPlace(column);
    beside.col(j) = column;
  }
  for (Eigen::Index j = 0; j < rest; j += D) {
    node.schur.template middleCols<D>(j).topRows(j + D).noalias() -=
        beside.leftCols(j + D).transpose() * beside.template middleCols<D>(j);
  }
  node.schur.col(rest).noalias() -= beside.leftCols(rest).transpose() * beside.col(rest);
  decrease_ += beside.col(rest).squaredNorm();
  node.separator.assign(front_poses.begin() + 1, front_poses.end());
  ++eliminations_;
}

template <int D>
bool EliminationTree<D>::solve(std::size_t pose) {
  Node& node = nodes_[pose];
  Vector right = node.rows.col(node.rows.cols() - 1);
  for (std::size_t k = 0; k < node.separator.size(); ++k) {
    right -= node.rows.template middleCols<D>(static_cast<Eigen::Index>(1 + k) * D) *
             nodes_[node.separator[k]].correction;
  }
  node.rows.template leftCols<D>().template triangularView<Eigen::Upper>().solveInPlace(right);
  constexpr double kUnchanged = 1e-9;  // [m], [rad]
  const bool changes = (right - node.correction).cwiseAbs().maxCoeff() > kUnchanged;
  node.correction = right;
  return changes;
}

template <int D>
std::vector<std::size_t> EliminationTree<D>::update(const std::vector<std::size_t>& touched,
                                                    const Graph& graph,
                                                    bool has_new_edges) {
  const std::vector<std::size_t> affected = affected_by(touched);
  const std::vector<std::size_t> order = has_new_edges ? ordered(graph) : affected;
  std::vector<std::size_t> orphans;
  for (const std::size_t pose : affected) {
    for (const std::size_t child : nodes_[pose].children) {
      if (is_marked_[child] == 0) orphans.push_back(child);
    }
    nodes_[pose].children.clear();
  }
  for (const std::size_t pose : order) {
    nodes_[pose].rank = next_rank_++;
    is_marked_[pose] = 0;
  }
  for (const std::size_t orphan : orphans) attach_to_parent(orphan);
  decrease_ = 0.0;
  for (const std::size_t pose : order) {
    eliminate(pose, graph);
    attach_to_parent(pose);
  }
  // Back-substitution: parents first, down to where nothing changes.
  std::vector<std::size_t> solved;
  std::vector<std::size_t> changed;
  const auto solve_and_mark = [&](std::size_t pose) {
    solved.push_back(pose);
    if (!solve(pose)) return;
    is_marked_[pose] = 1;
    changed.push_back(pose);
  };
  for (auto pose = order.rbegin(); pose != order.rend(); ++pose) solve_and_mark(*pose);
  std::vector<std::size_t> waiting = std::move(orphans);
  while (!waiting.empty()) {
    const std::size_t pose = waiting.back();
    waiting.pop_back();
    const Node& node = nodes_[pose];
    const auto is_changed = [&](std::size_t other) { return is_marked_[other] != 0; };
    if (std::ranges::none_of(node.separator, is_changed)) continue;
    solve_and_mark(pose);
    waiting.insert(waiting.end(), node.children.begin(), node.children.end());
  }
  for (const std::size_t pose : changed) is_marked_[pose] = 0;
  return solved;
}

template class EliminationTree<3>;
template class EliminationTree<6>;

}  // namespace loopbench::methods
