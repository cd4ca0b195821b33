#include "datasets/derive/closure_file.hpp"

#include <fmt/format.h>

#include <utility>

#include "datasets/derive/odometry.hpp"
#include "datasets/formats/columns.hpp"
#include "datasets/formats/g2o_information.hpp"
#include "datasets/formats/pose_rules.hpp"

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

std::vector<StampedClosure> read_closure_file(const std::filesystem::path& path,
                                              const ClosureNoise& noise) {
  TextFile file(path);
  std::vector<StampedClosure> out;
  for (Line line; file.next(line);) out.push_back(parse(file, line, noise));
  return out;
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
    if (edge.from == edge.to) {
      throw input_error(file.string(),
                        closure.line,
                        "both stamps match the same pose, expected two different poses");
    }
    if (edge.from > edge.to) {
      std::swap(edge.from, edge.to);
      edge.from_from_to = edge.from_from_to.inverse();
      edge.information = information_of_inverse(closure.from_from_to, edge.information);
    }
    edges.push_back(edge);
  }
  sort_closures(edges);
  return edges;
}

}  // namespace loopbench
