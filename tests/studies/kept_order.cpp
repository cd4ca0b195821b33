// Whether updates of a growing graph gain from keeping the elimination order: work of the Cholesky
// factorisations at 30 arrivals of closures, with an order that is kept and new poses appended,
// divided by the work with a new order each time. Prints a Markdown table for the public graphs in
// $LOOPBENCH_DATA.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "methods/solvers/elimination_structure.hpp"
#include "tests/support/public_graphs.hpp"

namespace loopbench {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

auto at(int i) { return static_cast<std::size_t>(i); }

std::vector<int> minimum_degree(int poses, const Pairs& pairs) {
  const methods::EliminationStructure structure(poses, pairs);
  std::vector<int> position(at(poses));
  for (int i = 0; i < poses; ++i) position[at(i)] = structure.position(i);
  return position;
}

/// Sum of the squared heights of the columns of the factor, of blocks: its multiplications.
double work(const std::vector<int>& position, const Pairs& pairs) {
  std::vector<std::vector<int>> columns(position.size());
  for (const auto& [i, j] : pairs) {
    const auto [first, second] = std::minmax(position[at(i)], position[at(j)]);
    columns[at(first)].push_back(second);
  }
  double sum = 0.0;
  for (std::vector<int>& rows : columns) {
    std::ranges::sort(rows);
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    sum += static_cast<double>((rows.size() + 1) * (rows.size() + 1));
    if (rows.empty()) continue;
    std::vector<int>& parent = columns[at(rows.front())];
    parent.insert(parent.end(), rows.begin() + 1, rows.end());
  }
  return sum;
}

struct Comparison {
  double ratio = 0.0;
  int orders = 0;
};

/// A kept order is replaced when the work per pose has grown by the factor `limit` under it.
Comparison compare(const Problem& problem, double limit) {
  constexpr std::size_t kUpdates = 30;
  Pairs pairs;
  std::vector<int> kept;
  double accepted = 0.0;
  double kept_work = 0.0;
  double new_work = 0.0;
  Comparison out;
  std::size_t odometry = 0;
  for (std::size_t update = 1; update <= kUpdates; ++update) {
    const std::size_t begin = (update - 1) * problem.closures.size() / kUpdates;
    const std::size_t end = update * problem.closures.size() / kUpdates;
    if (begin == end) continue;
    const std::size_t poses = problem.closures[end - 1].to + 1;
    const auto add = [&](const Edge& edge) {
      pairs.emplace_back(static_cast<int>(edge.from), static_cast<int>(edge.to));
    };
    for (std::size_t k = begin; k < end; ++k) add(problem.closures[k]);
    for (; odometry < problem.odometry.size() && problem.odometry[odometry].to < poses;
         ++odometry) {
      add(problem.odometry[odometry]);
    }
    const std::vector<int> fresh = minimum_degree(static_cast<int>(poses), pairs);
    const double least = work(fresh, pairs);
    new_work += least;
    while (kept.size() < poses) kept.push_back(static_cast<int>(kept.size()));
    double own = work(kept, pairs);
    if (accepted == 0.0 || own > limit * accepted * static_cast<double>(poses)) {
      kept = fresh;
      own = least;
      accepted = own / static_cast<double>(poses);
      ++out.orders;
    }
    kept_work += own;
  }
  out.ratio = kept_work / new_work;
  return out;
}

}  // namespace
}  // namespace loopbench

int main() {
  using namespace loopbench;
  const char* root = test::required_data();
  fmt::print("| graph | replaced at | orders | kept / new |\n| --- | ---: | ---: | ---: |\n");
  for (const std::string name : test::kPublicGraphs) {
    const Problem problem = test::public_graph(name, root);
    for (const double limit : {1.3, 2.0, 5.0}) {
      const Comparison each = compare(problem, limit);
      fmt::print("| {} | {} | {} | {:.2f} |\n", name, limit, each.orders, each.ratio);
    }
  }
}
