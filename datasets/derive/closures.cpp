#include "datasets/derive/closures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "datasets/columns/columns.hpp"
#include "datasets/columns/pose_rules.hpp"
#include "datasets/derive/odometry.hpp"
#include "datasets/derive/run_at_keyframes.hpp"
#include "datasets/formats/g2o.hpp"
#include "datasets/formats/g2o_information.hpp"
#include "datasets/noise/random.hpp"

namespace loopbench {
namespace {

StampedClosure parse(const TextFile& file, const Line& line, const ClosureNoise& noise) {
  const std::size_t count = count_columns(file, line);
  if (count != 9 && count != 11) {
    throw file.error(line.number,
                     fmt::format("has {} columns, expected 9 or 11: stamp_from stamp_to tx ty tz "
                                 "qx qy qz qw [sigma_t sigma_r]",
                                 count));
  }
  Columns columns(file, line);
  StampedClosure closure;
  closure.line = line.number;
  closure.noise = noise;
  closure.stamp_from = columns.number("stamp_from");
  closure.stamp_to = columns.number("stamp_to");
  Pose& pose = closure.from_from_to;
  for (double& x : pose.translation) x = columns.number("translation");
  for (double& x : pose.rotation.coeffs()) x = columns.number("quaternion");
  pose.rotation = normalized_rotation(file, line.number, pose.rotation);
  if (count == 11) {
    closure.noise = {columns.number("sigma_t"), columns.number("sigma_r")};
    if (!(closure.noise.sigma_t > 0.0 && closure.noise.sigma_r > 0.0)) {
      throw file.error(line.number,
                       fmt::format("found sigma_t {} and sigma_r {}, expected values > 0",
                                   closure.noise.sigma_t,
                                   closure.noise.sigma_r));
    }
  }
  return closure;
}

}  // namespace

std::vector<Edge> measure_closures_in_run(const Trajectory& keyframes,
                                          const Trajectory& run,
                                          const RevisitRule& rule,
                                          std::size_t max,
                                          const InterpolationLimits& reach,
                                          const ClosureNoise& noise) {
  const RunAtKeyframes shared = at_keyframes(keyframes, run, reach);
  const std::vector<Revisit> revisits = find_revisits(shared.run, rule);
  const Matrix6 information =
      isotropic_information(noise.sigma_t * noise.sigma_t, noise.sigma_r * noise.sigma_r);
  std::vector<Edge> closures;
  for (const std::size_t k :
       subsample(revisits, stamps(shared.run), max == 0 ? revisits.size() : max)) {
    const auto [from, to] = revisits[k];
    const Pose from_from_to =
        shared.run[from].world_from_body.inverse() * shared.run[to].world_from_body;
    closures.push_back(
        {shared.keyframe[from], shared.keyframe[to], normalized(from_from_to), information});
  }
  return closures;
}

std::vector<Edge> with_noise(std::vector<Edge> edges,
                             const ClosureNoise& noise,
                             const NoiseStream& stream,
                             const std::optional<Vector3>& normal) {
  Random random(stream, Purpose::closures);
  for (Edge& edge : edges) {
    Twist error = random.normal_twist(noise.sigma_t, noise.sigma_r);
    if (normal) {
      error.head<3>() -= *normal * normal->dot(error.head<3>());
      error.tail<3>() = *normal * normal->dot(error.tail<3>());
    }
    edge.from_from_to = normalized(edge.from_from_to * exp_se3(error));
  }
  return edges;
}

double path_length_ratio(const Trajectory& keyframes,
                         const Trajectory& run,
                         const InterpolationLimits& reach) {
  const RunAtKeyframes shared = at_keyframes(keyframes, run, reach);
  Trajectory estimate;
  for (const std::size_t i : shared.keyframe) estimate.push_back(keyframes[i]);
  const double length = path_length(estimate);
  return length > 0.0 ? path_length(shared.run) / length : 1.0;
}

Edge start_equals_end(const Trajectory& poses, double sigma_t) {
  constexpr double kUnknown = 10.0;  // [rad]
  const Rotation& first = poses.front().world_from_body.rotation;
  const Rotation& last = poses.back().world_from_body.rotation;
  return {0,
          poses.size() - 1,
          normalized(Pose{first.conjugate() * last, Vector3::Zero()}),
          isotropic_information(sigma_t * sigma_t, kUnknown * kUnknown)};
}

void sort_closures(std::vector<Edge>& closures, std::vector<std::size_t>* marked) {
  std::vector<std::size_t> before(closures.size());  // index of each sorted closure
  std::iota(before.begin(), before.end(), std::size_t{0});
  std::ranges::stable_sort(
      before, {}, [&](std::size_t k) { return std::pair(closures[k].to, closures[k].from); });
  std::vector<Edge> sorted;
  std::vector<std::size_t> after(closures.size());
  sorted.reserve(closures.size());
  for (const std::size_t k : before) {
    after[k] = sorted.size();
    sorted.push_back(closures[k]);
  }
  closures = std::move(sorted);
  if (marked == nullptr) return;
  for (std::size_t& k : *marked) k = after[k];
  std::ranges::sort(*marked);
}

std::vector<StampedClosure> read_closure_file(const std::filesystem::path& path,
                                              const ClosureNoise& noise) {
  TextFile file(path);
  std::vector<StampedClosure> out;
  for (Line line; file.next(line);) out.push_back(parse(file, line, noise));
  return out;
}

std::size_t move_to_poses(std::vector<StampedClosure>& closures,
                          const Trajectory& poses,
                          const Trajectory& run,
                          const InterpolationLimits& reach) {
  constexpr double kSame = 1e-4;  // [s]; stamps are printed with four digits at least
  const auto move = [&](double& stamp, Pose& pose_from_measured) {
    const auto nearest = nearest_pose(poses, stamp, std::numeric_limits<double>::infinity());
    if (!nearest) return false;
    const double there = poses[*nearest].stamp;
    if (std::abs(there - stamp) <= kSame) return false;
    const auto tracked = poses_at(run, {there, stamp}, reach);
    if (!tracked[0] || !tracked[1]) return false;
    pose_from_measured = normalized(tracked[0]->inverse() * *tracked[1]);
    stamp = there;
    return true;
  };
  std::size_t moved = 0;
  for (StampedClosure& each : closures) {
    const bool is_from_moved = move(each.stamp_from, each.pose_from_measured_from);
    const bool is_to_moved = move(each.stamp_to, each.pose_from_measured_to);
    moved += is_from_moved || is_to_moved ? 1 : 0;
  }
  return moved;
}

std::vector<Edge> as_edges(const std::vector<StampedClosure>& closures,
                           const Trajectory& poses,
                           double max_diff,
                           const std::filesystem::path& file) {
  std::vector<Edge> edges;
  for (const StampedClosure& closure : closures) {
    const auto pose_at = [&](double stamp) {
      const auto index = nearest_pose(poses, stamp, max_diff);
      if (index) return *index;
      throw input_error(
          file.string(),
          closure.line,
          fmt::format("found stamp {:.6f}, expected one within {} s of a pose of the estimate",
                      stamp,
                      max_diff));
    };
    const auto& [sigma_t, sigma_r] = closure.noise;
    Edge edge{pose_at(closure.stamp_from),
              pose_at(closure.stamp_to),
              closure.from_from_to,
              isotropic_information(sigma_t * sigma_t, sigma_r * sigma_r)};
    const Pose& to = closure.pose_from_measured_to;
    if (to.translation != Vector3::Zero() || to.rotation.vec() != Vector3::Zero()) {
      // Z exp(e) B^-1 = Z B^-1 exp(Ad(B) e)
      const Matrix6 A = adjoint(to.inverse());
      const Matrix6 moved = A.transpose() * edge.information * A;
      edge.information = 0.5 * (moved + moved.transpose());
    }
    edge.from_from_to =
        normalized(closure.pose_from_measured_from * edge.from_from_to * to.inverse());
    if (edge.from == edge.to) {
      throw input_error(file.string(),
                        closure.line,
                        "both stamps match the same pose, expected two different poses");
    }
    if (edge.from > edge.to) {
      std::swap(edge.from, edge.to);
      edge.information = information_of_inverse(edge.from_from_to, edge.information);
      edge.from_from_to = edge.from_from_to.inverse();
    }
    edges.push_back(edge);
  }
  sort_closures(edges);
  return edges;
}

std::vector<Edge> read_graph_closures(const std::filesystem::path& file, const Trajectory& poses) {
  const PoseGraph graph = read_g2o(file);
  std::vector<Edge> out;
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    Edge edge = graph.edges[i];
    for (std::size_t* const end : {&edge.from, &edge.to}) {
      if (graph.ids.size() != poses.size()) *end = static_cast<std::size_t>(graph.ids[*end]);
      if (*end < poses.size()) continue;
      throw input_error(file.string(),
                        graph.lines[i],
                        fmt::format("found vertex {}, expected 0 to {}: one for each pose",
                                    static_cast<std::int64_t>(*end),
                                    poses.size() - 1));
    }
    if (edge.to != edge.from + 1) out.push_back(edge);
  }
  sort_closures(out);
  return out;
}

}  // namespace loopbench
