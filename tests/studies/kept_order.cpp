// Whether updates of a growing graph gain from keeping the elimination order: work of the Cholesky
// factorisations at 30 arrivals of closures, with an order that is kept and new poses appended,
// divided by the work with a new order each time. Prints a Markdown table for the public graphs in
// $LOOPBENCH_DATA.
#include "methods/solvers/kept_order.hpp"

#include <fmt/format.h>

#include <utility>

#include "tests/support/public_graphs.hpp"

namespace loopbench {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

struct Comparison {
  double ratio = 0.0;
  int orders = 0;
};

Comparison compare(const Problem& problem, double limit) {
  constexpr std::size_t kUpdates = 30;
  Pairs pairs;
  methods::KeptOrder order(limit);
  double kept_work = 0.0;
  double new_work = 0.0;
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
    const auto blocks = static_cast<int>(poses);
    new_work += methods::EliminationStructure(blocks, pairs).work();
    kept_work += order.structure(blocks, pairs).work();
  }
  return {kept_work / new_work, order.computed()};
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
