/// What `pose_graph` costs on street grids with as many closures as poses, in processor time.
///
/// graph_growth POSES...   table in Markdown for planar and spatial graphs of these sizes
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "datasets/derive/odometry.hpp"
#include "methods/solvers/groups/se2.hpp"
#include "methods/solvers/groups/se3.hpp"
#include "methods/solvers/initial_values.hpp"
#include "methods/solvers/normal_equations.hpp"

namespace {

using namespace loopbench;
using namespace loopbench::methods;

/// Processor time of all threads [s].
template <class Run>
double cpu_seconds(Run run) {
  const std::clock_t begin = std::clock();
  run();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

constexpr int kRepeats = 3;  // of which the least is taken: other processes share the cores

template <class Run>
double least_cpu_seconds(Run run) {
  double out = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < kRepeats; ++repeat) out = std::min(out, cpu_seconds(run));
  return out;
}

/// A walk over streets one metre apart, on a square with one crossing for three poses, whatever the
/// size. Closures measure earlier poses at the same or a neighbouring crossing, at most two for
/// each pose, until there are as many as poses.
Problem streets(std::size_t poses, bool planar) {
  const int side = std::max(4, static_cast<int>(std::sqrt(static_cast<double>(poses) / 3.0)));
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  constexpr int kAround[5][2] = {{0, 0}, {1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  Problem out;
  out.planar = planar;
  std::vector<Pose> truth;
  const auto measured = [&](std::size_t from, std::size_t to) {
    Twist noise;
    for (int i = 0; i < 6; ++i) noise[i] = (i < 3 ? 0.05 : 0.01) * normal(random);
    if (planar) noise[2] = noise[3] = noise[4] = 0.0;
    return normalized(truth[from].inverse() * truth[to] * exp_se3(noise));
  };
  const Matrix6 information = isotropic_information(0.05 * 0.05, 0.01 * 0.01);
  std::map<std::pair<int, int>, std::size_t> last;  // pose at each crossing
  int x = side / 2, y = side / 2, heading = 0;
  for (std::size_t i = 0; i < poses; ++i) {
    truth.push_back({exp_so3({0.0, 0.0, M_PI_2 * heading}), Vector3(x, y, 0.0)});
    Pose start = truth.back();
    if (i > 0) {
      out.odometry.push_back({i - 1, i, measured(i - 1, i), information});
      start = out.keyframes.back().world_from_body * out.odometry.back().from_from_to;
    }
    out.keyframes.push_back({static_cast<double>(i), normalized(start)});
    std::vector<std::size_t> seen;
    for (const auto& [dx, dy] : kAround) {
      const auto found = last.find({x + dx, y + dy});
      if (found != last.end() && found->second + 10 < i) seen.push_back(found->second);
    }
    std::ranges::sort(seen);
    for (std::size_t k = 0; k < std::min<std::size_t>(2, seen.size()); ++k) {
      if (out.closures.size() > i) break;
      out.closures.push_back({seen[k], i, measured(seen[k], i), information});
    }
    last[{x, y}] = i;
    if (random() % 3 == 0) heading = (heading + (random() % 2 == 0 ? 1 : 3)) % 4;
    const auto leaves = [&](int h) {
      const int nx = x + kAround[h + 1][0], ny = y + kAround[h + 1][1];
      return std::min(nx, ny) < 0 || std::max(nx, ny) >= side;
    };
    while (leaves(heading)) heading = (heading + 1) % 4;
    x += kAround[heading + 1][0];
    y += kAround[heading + 1][1];
  }
  return out;
}

struct GraphCost {
  std::size_t closures = 0;
  int iterations = 0;
  double all = 0.0, initial = 0.0, ordering = 0.0, factorisation = 0.0, linearisation = 0.0;  // [s]
};

/// The parts of one solution from the chordal start: each is timed alone at the solution, and
/// counted once for each iteration. The rest is memory and the terms of the edges.
template <class G>
GraphCost cost_of(const Problem& problem, Group group) {
  GraphCost out;
  out.closures = problem.closures.size();
  PoseGraphSettings settings;
  settings.group = group;
  const std::vector<double> weights(problem.closures.size(), 1.0);
  const WeightedEdges edges{problem.odometry, problem.closures, weights};
  std::vector<ScaledPose> poses;
  out.all = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    EliminationCache cache;
    const double initial =
        cpu_seconds([&] { poses = chordal_values(problem, settings.scale_sigma, cache); });
    const double solved = cpu_seconds(
        [&] { out.iterations = solve_pose_graph(poses, edges, settings, cache).iterations; });
    if (initial + solved >= out.all) continue;
    out.all = initial + solved;
    out.initial = initial;
  }
  std::vector<std::pair<int, int>> pairs;
  edges.for_each([&](const Edge& edge, double, bool) {
    if (edge.from > 0)
      pairs.emplace_back(static_cast<int>(edge.from) - 1, static_cast<int>(edge.to) - 1);
  });
  const int blocks = static_cast<int>(problem.keyframes.size()) - 1;
  out.ordering = least_cpu_seconds([&] { EliminationStructure(blocks, pairs); });
  EliminationCache cache;
  NormalEquations<G> equations(poses.size(), edges, settings, cache);
  std::vector<typename G::Element> x;
  const ScaledPose first_from_world = poses.front().inverse();
  for (const ScaledPose& each : poses) x.push_back(G::from(first_from_world * each));
  typename NormalEquations<G>::Step step;
  double linearised = std::numeric_limits<double>::infinity(), solved = linearised;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    linearised = std::min(linearised, cpu_seconds([&] { equations.linearise(x); }));
    solved = std::min(solved, cpu_seconds([&] { equations.solve(1e-9, step); }));
  }
  out.linearisation = out.iterations * linearised;
  out.factorisation = out.iterations * solved;
  return out;
}

void print_table(const std::vector<std::size_t>& sizes, bool planar) {
  fmt::print(
      "| {} poses | closures | iterations | time [s] | exponent | ordering | factorisation | "
      "linearisation | initial values | other |\n"
      "| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
      planar ? "planar" : "spatial");
  double before = 0.0;
  std::size_t smaller = 0;
  for (const std::size_t size : sizes) {
    const Problem problem = streets(size, planar);
    const GraphCost cost =
        planar ? cost_of<Se2>(problem, Group::se2) : cost_of<Se3>(problem, Group::se3);
    const double initial = cost.initial - cost.ordering;
    const auto share = [&](double seconds) {
      return fmt::format("{:.0f} %", 100.0 * seconds / cost.all);
    };
    const double other =
        cost.all - initial - cost.ordering - cost.factorisation - cost.linearisation;
    const std::string exponent =
        smaller == 0
            ? "-"
            : fmt::format("{:.2f}",
                          std::log(cost.all / before) /
                              std::log(static_cast<double>(size) / static_cast<double>(smaller)));
    fmt::print("| {} | {} | {} | {:.2f} | {} | {} | {} | {} | {} | {} |\n",
               size,
               cost.closures,
               cost.iterations,
               cost.all,
               exponent,
               share(cost.ordering),
               share(cost.factorisation),
               share(cost.linearisation),
               share(initial),
               share(other));
    std::fflush(stdout);
    before = cost.all;
    smaller = size;
  }
  fmt::print("\n");
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::size_t> sizes;
  for (int i = 1; i < argc; ++i) sizes.push_back(std::strtoul(argv[i], nullptr, 10));
  if (sizes.empty()) {
    fmt::print("usage: graph_growth POSES...\n");
    return 2;
  }
  for (const bool planar : {true, false}) print_table(sizes, planar);
  return 0;
}
