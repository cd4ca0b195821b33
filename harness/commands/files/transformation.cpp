#include "harness/commands/files/transformation.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "datasets/core/mirrored.hpp"
#include "datasets/files/regular_file.hpp"
#include "metrics/doctor/order_checks.hpp"

namespace loopbench::harness {
namespace {

Similarity from_numbers(const std::vector<double>& v, double scale, const std::string& where) {
  Similarity out{{Rotation::Identity(), {v[0], v[1], v[2]}}, scale};
  if (v.size() == 7) {
    out.pose.rotation = Rotation(v[6], v[3], v[4], v[5]);
    const double norm = out.pose.rotation.norm();
    if (!(std::abs(norm - 1.0) <= 1e-2)) {
      throw InputError(where + ": quaternion has norm " + std::to_string(norm) + ", expected 1");
    }
    out.pose.rotation.normalize();
  }
  if (!(scale > 0.0) || !std::isfinite(scale)) {
    throw InputError(where + ": scale = " + std::to_string(scale) + ", expected scale > 0");
  }
  return out;
}

Similarity from_json(const std::string& file) {
  constexpr std::size_t kMost = 1 << 20;  // [bytes]
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    throw InputError("'" + file +
                     "': expected x,y,z or x,y,z,qx,qy,qz,qw, or an existing JSON file");
  }
  const std::string text = read_named_file(file, kMost, "a transform in JSON");
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) throw InputError(file + ": is not a JSON object");
  const auto number = [&](const char* key, std::optional<double> otherwise) {
    const auto found = json.find(key);
    if (found == json.end() && otherwise) return *otherwise;
    if (found == json.end() || !found->is_number()) {
      throw InputError(file +
                       ": expected numbers x, y, z, qx, qy, qz, qw and, optionally, scale; '" +
                       key + "' is missing or no number");
    }
    return found->get<double>();
  };
  std::vector<double> values;
  for (const char* key : {"x", "y", "z", "qx", "qy", "qz", "qw"}) {
    values.push_back(number(key, std::nullopt));
  }
  return from_numbers(values, number("scale", 1.0), file);
}

[[noreturn]] void reject_axes(const std::string& text) {
  throw InputError("--axes: found '" + text +
                   "', expected x, y and z in any order, each with an optional minus, such as "
                   "--axes=-y,x,z");
}

Matrix3 signed_permutation(const std::string& text) {
  Matrix3 out = Matrix3::Zero();
  int row = 0;
  double sign = 1.0;
  for (const char c : text) {
    if (c == ' ' || c == ',') continue;
    if (c == '-' && sign > 0.0) {
      sign = -1.0;
      continue;
    }
    if (c < 'x' || c > 'z' || row == 3) reject_axes(text);
    out(row++, c - 'x') = sign;
    sign = 1.0;
  }
  if (row != 3 || sign < 0.0 || !out.colwise().any().all()) reject_axes(text);
  return out;
}

void check_factor(const char* name, double factor) {
  if (factor > 0.0 && std::isfinite(factor)) return;
  throw InputError(fmt::format("{} = {:g}, expected a number > 0", name, factor));
}

/// The reader has put each component one place further, or one place back.
Rotation reordered(const Rotation& q, const std::string& actual) {
  return actual == "wxyz" ? Rotation(q.x(), q.y(), q.z(), q.w())
                          : Rotation(q.z(), q.w(), q.x(), q.y());
}

}  // namespace

std::vector<double> comma_separated_numbers(const std::string& text) {
  std::vector<double> out;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    double value = 0.0;
    const auto [rest, error] = std::from_chars(at, end, value);
    if (error != std::errc{} || !std::isfinite(value)) return {};
    if (rest != end && *rest != ',') return {};
    out.push_back(value);
    if (rest == end) return out;
    for (at = rest + 1; at != end && *at == ' ';) ++at;
  }
}

Similarity read_similarity(const std::string& text) {
  const std::vector<double> values = comma_separated_numbers(text);
  if (values.size() == 3 || values.size() == 7) return from_numbers(values, 1.0, text);
  return from_json(text);
}

Similarity inverse(const Similarity& similarity) {
  Similarity out{similarity.pose.inverse(), 1.0 / similarity.scale};
  out.pose.translation *= out.scale;
  return out;
}

Trajectory transformed(Trajectory poses, const Similarity& similarity, TransformSide side) {
  if (side != TransformSide::left && similarity.scale != 1.0) {
    throw InputError("transform: a scale is possible on the left only");
  }
  if (side != TransformSide::left && lacks_rotations(poses)) {
    throw InputError("transform: --right needs rotations, expected --left for positions");
  }
  if (side == TransformSide::right_propagated) {
    const Trajectory given = poses;
    for (std::size_t i = 1; i < poses.size(); ++i) {
      const Pose step = given[i - 1].world_from_body.inverse() * given[i].world_from_body;
      poses[i].world_from_body =
          normalized(poses[i - 1].world_from_body * (step * similarity.pose));
    }
    return poses;
  }
  for (auto& [stamp, pose] : poses) {
    if (side == TransformSide::left) {
      pose.translation *= similarity.scale;
      pose = normalized(similarity.pose * pose);
    } else {
      pose = normalized(pose * similarity.pose);
    }
  }
  return poses;
}

TrajectoryFile corrected(TrajectoryFile file, const Conventions& conventions) {
  if (conventions == Conventions{}) return file;
  const std::string& order = conventions.quaternion_order;
  if (!order.empty() && order != "wxyz" && order != "xyzw") {
    throw InputError("--quaternion-order = " + order + ", expected wxyz or xyzw");
  }
  const std::size_t mirrored_axis = std::string_view("xyz").find(conventions.mirror);
  if (conventions.mirror.size() > 1 || mirrored_axis == std::string_view::npos) {
    throw InputError("--mirror = " + conventions.mirror + ", expected x, y or z");
  }
  check_factor("--scale", conventions.scale);
  check_factor("--stamp-scale", conventions.stamp_scale);
  const bool needs_rotations = conventions.invert_poses || conventions.chain;
  if (needs_rotations && lacks_rotations(file.poses)) {
    throw InputError(std::string(conventions.chain ? "--chain" : "--invert-poses") +
                     " needs rotations, the file has only positions");
  }
  const Matrix3 axes =
      conventions.axes.empty() ? Matrix3::Identity() : signed_permutation(conventions.axes);
  for (auto& [stamp, pose] : file.poses) {
    if (!order.empty()) pose.rotation = reordered(pose.rotation, order);
    if (conventions.conjugate) pose.rotation = pose.rotation.conjugate();
    pose.translation = conventions.scale * (axes * pose.translation);
    if (!conventions.mirror.empty()) pose = mirrored(pose, static_cast<int>(mirrored_axis));
    stamp *= conventions.stamp_scale;
    if (conventions.invert_poses) pose = normalized(pose.inverse());
  }
  if (conventions.chain) file.poses = metrics::chained(file.poses);
  Conventions of_stamps;
  of_stamps.stamp_scale = conventions.stamp_scale;
  if (conventions != of_stamps) file.covariances.clear();
  if (conventions.stamp_scale != 1.0) file.nanoseconds.clear();
  return file;
}

}  // namespace loopbench::harness
