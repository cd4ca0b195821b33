#include "tests/studies/edge_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "datasets/core/se3.hpp"
#include "datasets/derive/graph_parts.hpp"
#include "datasets/formats/g2o.hpp"
#include "metrics/doctor/loop_chain.hpp"
#include "metrics/doctor/sampling.hpp"

namespace loopbench {
namespace {

constexpr std::size_t kFewestForConventions = 3;
constexpr double kLeastChange = 0.1;  // [m], [rad]: smaller ones are no fault

/// Planar files have one angle: no quaternions, no axes of cameras.
std::function<bool(Problem&, std::mt19937&)> each_closure(Pose (*change)(const Pose&),
                                                          bool is_spatial = false) {
  return [=](Problem& p, std::mt19937&) {
    std::size_t changed = 0;
    for (Edge& edge : p.closures) {
      const Pose before = std::exchange(edge.from_from_to, change(edge.from_from_to));
      changed += is_close(before, edge.from_from_to, kLeastChange, kLeastChange) ? 0 : 1;
    }
    return p.closures.size() >= kFewestForConventions && 2 * changed > p.closures.size() &&
           !(is_spatial && p.planar);
  };
}

/// Motion of a camera (right, down, forward) instead of a vehicle (forward, left, up).
Pose between_cameras(const Pose& p) {
  const Pose camera{Rotation(0.5, -0.5, 0.5, -0.5), Vector3::Zero()};
  return camera.inverse() * p * camera;
}

/// Further than any drift from where the odometry ends.
bool add_false_closure(Problem& problem, std::mt19937& random) {
  const std::size_t n = problem.keyframes.size();
  const std::size_t from = n / 10 + random() % (n / 4), to = n / 2 + random() % (n / 3);
  const Pose odometry =
      problem.keyframes[from].world_from_body.inverse() * problem.keyframes[to].world_from_body;
  Edge edge = problem.closures.front();
  edge.from = from;
  edge.to = to;
  edge.from_from_to = odometry.translation.norm() > 60.0
                          ? Pose{exp_so3({0, 0, 0.7}), {1, 0.5, 0}}
                          : Pose{odometry.rotation, odometry.translation + Vector3(60, 40, 0)};
  problem.closures.push_back(edge);
  return edge.scale == 1.0 && problem.closures.size() > kFewestForConventions;
}

/// Whether most gaps are as long as a third of their loops, so that the closures are false.
bool are_false(const Problem& problem) {
  constexpr double kMostDrift = 1.0 / 3.0;
  const metrics::Chain chain = metrics::chain_of(problem);
  std::vector<double> gaps;
  for (const Edge& edge : problem.closures) {
    const metrics::LoopPath path{&edge};
    gaps.push_back(path.residual(chain, [](const Pose& p) { return p; }).head<3>().norm() /
                   chain.distance(edge.from, edge.to));
  }
  return metrics::median_value(std::move(gaps)) > kMostDrift;
}

std::function<bool(Problem&, std::mt19937&)> information(bool of_odometry, double factor) {
  return [=](Problem& p, std::mt19937&) {
    if (are_false(p)) return false;
    for (Edge& edge : p.odometry) edge.information *= of_odometry ? factor : 1.0;
    for (Edge& edge : p.closures) edge.information *= factor;
    return p.closures.size() >= kFewestForConventions;
  };
}

}  // namespace

std::vector<PlantedEdges> edge_faults() {
  return {
      {"closures inverted", "closure_direction", each_closure([](const Pose& p) {
         return p.inverse();
       })},
      {"closures w x y z",
       "closure_convention",
       each_closure(
           [](const Pose& p) -> Pose {
             const Rotation& q = p.rotation;
             return {Rotation(q.z(), q.w(), q.x(), q.y()), p.translation};
           },
           true)},
      {"inverted rotations of closures",
       "closure_convention",
       each_closure([](const Pose& p) -> Pose {
         return {p.rotation.conjugate(), p.translation};
       })},
      {"closures of another body", "closure_convention", each_closure(between_cameras, true)},
      {"identities as closures", "placeholders", each_closure([](const Pose&) { return Pose{}; })},
      {"a false closure", "closure_gap", add_false_closure},
      {"information x 1e6", "information", information(true, 1e6)},
      {"information / 1e8", "information", information(true, 1e-8)},
  };
}

bool exceeds_noise(const Problem& right, const Problem& planted) {
  constexpr double kNoise = 1.0, kContradiction = 36.0;  // chi-squared per degree of freedom
  const metrics::Chain chain = metrics::chain_of(planted);
  const bool is_added = planted.closures.size() > right.closures.size();
  std::vector<double> largest;
  for (const metrics::LoopPaths& each : metrics::loop_paths(planted.closures, chain)) {
    const Edge& edge = *each.odometry.closure;
    const auto index = static_cast<std::size_t>(&edge - planted.closures.data());
    const bool is_new = index >= right.closures.size();
    if (is_new != is_added) continue;
    const auto chi_squared = [&](const metrics::LoopPath& path) {
      const Twist change =
          is_new ? path.residual(chain, [](const Pose& p) { return p; })
                 : log_se3(right.closures[index].from_from_to.inverse() * edge.from_from_to);
      return change.dot(path.covariance.ldlt().solve(change)) / 6.0;
    };
    largest.push_back(chi_squared(each.odometry));
    for (const metrics::LoopPath& path : each.over_closures)
      largest.back() = std::max(largest.back(), chi_squared(path));
  }
  return metrics::median_value(largest) > (is_added ? kContradiction : kNoise);
}

std::vector<NamedProblem> measured_graphs(const std::filesystem::path& data) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data)) {
    if (entry.path().extension() == ".g2o") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::vector<NamedProblem> out;
  for (const std::filesystem::path& file : files) {
    try {
      const PoseGraph graph = read_g2o(file);
      GraphParts parts = split_graph(graph, file);
      if (parts.closures.empty() || parts.odometry.size() + 1 != graph.ids.size()) continue;
      Problem problem{.keyframes = initial_poses(graph, 0.1)};
      problem.odometry = std::move(parts.odometry);
      problem.closures = std::move(parts.closures);
      problem.planar = graph.planar;
      out.emplace_back(file.lexically_relative(data).string(), std::move(problem));
    } catch (const InputError& error) {
      fmt::print(stderr, "skipped: {}\n", error.what());
    }
  }
  return out;
}

NamedProblem simulated_graph(std::mt19937& random) {
  constexpr std::size_t kLoops[] = {1, 2, 3, 10, 40};
  std::normal_distribution<double> normal;
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const std::size_t n = 60 + random() % 240, loops = kLoops[random() % 5];
  const bool is_planar = random() % 2 == 0, has_scale = random() % 4 == 0,
             is_biased = random() % 3 == 0;
  const bool is_to_first = random() % 3 == 0;
  const double metres = uniform(0.005, 0.05), radians = uniform(0.001, 0.01),
               step = uniform(0.3, 2.0);
  const Vector3 shape(1, 1, is_planar ? 0 : 1), axes(is_planar ? 0 : 1, is_planar ? 0 : 1, 1);
  const auto noise = [&](double factor) {
    const auto vector = [&] { return Vector3(normal(random), normal(random), normal(random)); };
    return exp_se3(factor * twist(metres * vector().cwiseProduct(shape),
                                  radians * vector().cwiseProduct(axes)));
  };
  Problem out;
  out.planar = is_planar;
  const Twist bias = is_biased ? log_se3(noise(0.5)) : Twist::Zero();
  Matrix6 information = Matrix6::Zero();
  information.diagonal() << Vector3::Constant(1.0 / (metres * metres)),
      Vector3::Constant(1.0 / (radians * radians));
  std::vector<Pose> truth{Pose{}};
  std::vector<double> scales{1.0};
  const double turn = 2.0 * M_PI / uniform(15.0, 0.5 * static_cast<double>(n)),
               height = uniform(0.0, 0.05);
  out.keyframes.push_back({0.0, {}});
  for (std::size_t i = 1; i < n; ++i) {
    const Vector3 rate(
        height * normal(random), height * normal(random), turn + 0.1 * normal(random));
    const Pose moved = exp_se3(twist({step, 0, 0}, rate.cwiseProduct(axes)));
    truth.push_back(normalized(truth.back() * moved));
    scales.push_back(has_scale ? scales.back() * std::exp(0.003 + 0.002 * normal(random)) : 1.0);
    Edge edge{i - 1, i, normalized(moved * noise(1.0) * exp_se3(bias)), information};
    edge.from_from_to.translation /= scales[i - 1];
    out.odometry.push_back(edge);
    out.keyframes.push_back({0.1 * static_cast<double>(i),
                             normalized(out.keyframes.back().world_from_body * edge.from_from_to)});
  }
  for (std::size_t k = 0; k < loops; ++k) {
    const std::size_t to = n - 1 - random() % (n / 3),
                      from = is_to_first ? random() % 3 : random() % (n / 3);
    Edge edge{from, to, normalized(truth[from].inverse() * truth[to] * noise(1.0)), information};
    edge.from_from_to.translation /= scales[from];
    edge.scale = has_scale ? scales[from] / scales[to] : 1.0;
    out.closures.push_back(edge);
  }
  std::ranges::sort(out.closures, {}, [](const Edge& e) { return std::pair(e.to, e.from); });
  return {fmt::format("{} {} {}{}, {} loops",
                      is_planar ? "planar" : "spatial",
                      has_scale ? "Sim(3)" : "SE(3)",
                      is_biased ? "biased" : "as stated",
                      is_to_first ? ", to the first" : "",
                      loops),
          std::move(out)};
}

}  // namespace loopbench
