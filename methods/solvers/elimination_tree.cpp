#include "methods/solvers/elimination_tree.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "methods/solvers/elimination_order.hpp"

namespace loopbench::methods {

void EliminationTree::add_pose() {
  nodes_.emplace_back().correction = Eigen::VectorXd::Zero(d_);
  is_marked_.push_back(0);
  slot_.push_back(-1);
}

std::vector<std::size_t> EliminationTree::affected_by(const std::vector<std::size_t>& touched) {
  std::vector<std::size_t> out;
  for (std::size_t pose : touched) {
    for (; pose != kNone && pose != 0 && is_marked_[pose] == 0; pose = nodes_[pose].parent) {
      is_marked_[pose] = 1;
      out.push_back(pose);
    }
  }
  std::ranges::sort(out);
  return out;
}

std::vector<std::size_t> EliminationTree::ordered(const std::vector<std::size_t>& affected,
                                                  const Graph& graph) {
  std::vector<std::vector<std::size_t>> cliques;
  for (const std::size_t pose : affected) {
    for (const std::size_t edge : graph.edges_of(pose)) {
      const EdgeEquations& of = graph.equations(edge);
      if (of.from == pose && is_marked_[of.to] != 0) cliques.push_back({of.from, of.to});
    }
    for (const std::size_t child : nodes_[pose].children) {
      if (is_marked_[child] == 0) cliques.push_back(nodes_[child].separator);
    }
  }
  return elimination_order(affected, cliques);
}

void EliminationTree::attach_to_parent(std::size_t pose) {
  Node& node = nodes_[pose];
  const auto rank_of = [&](std::size_t other) { return nodes_[other].rank; };
  const auto first = std::ranges::min_element(node.separator, {}, rank_of);
  node.parent = first == node.separator.end() ? kNone : *first;
  if (node.parent != kNone) nodes_[node.parent].children.push_back(pose);
}

void EliminationTree::add_block(Eigen::MatrixXd& front,
                                const Eigen::MatrixXd& block,
                                const std::vector<std::size_t>& poses) const {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Index row = slot_[poses[i]];
    if (row < 0) continue;  // pose 0
    const auto from_row = static_cast<Eigen::Index>(i) * d_;
    for (std::size_t j = 0; j < poses.size(); ++j) {
      const Eigen::Index column = slot_[poses[j]];
      if (column < 0) continue;
      front.block(row * d_, column * d_, d_, d_) +=
          block.block(from_row, static_cast<Eigen::Index>(j) * d_, d_, d_);
    }
    front.col(front.cols() - 1).segment(row * d_, d_) +=
        block.col(block.cols() - 1).segment(from_row, d_);
  }
}

void EliminationTree::eliminate(std::size_t pose, const Graph& graph) {
  Node& node = nodes_[pose];
  std::vector<std::size_t> front_poses;
  const auto add = [&](std::size_t other) {
    if (other == 0 || slot_[other] >= 0) return;
    slot_[other] = static_cast<Eigen::Index>(front_poses.size());
    front_poses.push_back(other);
  };
  add(pose);
  std::vector<std::size_t> own;  // an edge belongs to the pose that is eliminated first
  for (const std::size_t edge : graph.edges_of(pose)) {
    const EdgeEquations& of = graph.equations(edge);
    const std::size_t other = of.from == pose ? of.to : of.from;
    if (other != 0 && nodes_[other].rank < node.rank) continue;
    own.push_back(edge);
    add(other);
  }
  for (const std::size_t child : node.children) {
    for (const std::size_t other : nodes_[child].separator) add(other);
  }
  const auto size = static_cast<Eigen::Index>(front_poses.size()) * d_;
  Eigen::MatrixXd front = Eigen::MatrixXd::Zero(size, size + 1);
  for (const std::size_t edge : own) {
    const EdgeEquations& of = graph.equations(edge);
    add_block(front, of.matrix, {of.from, of.to});
  }
  for (const std::size_t child : node.children) {
    add_block(front, nodes_[child].schur, nodes_[child].separator);
  }
  for (const std::size_t other : front_poses) slot_[other] = -1;

  const Eigen::LLT<Eigen::MatrixXd> factor(front.topLeftCorner(d_, d_));
  if (factor.info() != Eigen::Success) {
    throw std::runtime_error("the normal equations of keyframe " + std::to_string(pose) +
                             " are not positive definite");
  }
  const Eigen::Index rest = size - d_;
  node.rows.resize(d_, size + 1);
  node.rows.leftCols(d_) = factor.matrixU();
  node.rows.rightCols(rest + 1) = factor.matrixL().solve(front.topRightCorner(d_, rest + 1));
  node.schur = front.bottomRightCorner(rest, rest + 1);
  node.schur.noalias() -=
      node.rows.middleCols(d_, rest).transpose() * node.rows.rightCols(rest + 1);
  node.separator.assign(front_poses.begin() + 1, front_poses.end());
  ++eliminations_;
}

bool EliminationTree::solve(std::size_t pose) {
  Node& node = nodes_[pose];
  Eigen::VectorXd right = node.rows.col(node.rows.cols() - 1);
  for (std::size_t k = 0; k < node.separator.size(); ++k) {
    right -= node.rows.middleCols(static_cast<Eigen::Index>(1 + k) * d_, d_) *
             nodes_[node.separator[k]].correction;
  }
  node.rows.leftCols(d_).triangularView<Eigen::Upper>().solveInPlace(right);
  constexpr double kUnchanged = 1e-9;  // [m], [rad]
  const bool changes = (right - node.correction).cwiseAbs().maxCoeff() > kUnchanged;
  node.correction = std::move(right);
  return changes;
}

std::vector<std::size_t> EliminationTree::update(const std::vector<std::size_t>& touched,
                                                 const Graph& graph) {
  const std::vector<std::size_t> affected = affected_by(touched);
  const std::vector<std::size_t> order = ordered(affected, graph);
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

}  // namespace loopbench::methods
