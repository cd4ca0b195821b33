#include "harness/trajectory/transformation.hpp"

#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "harness/text/numbers.hpp"

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
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    throw InputError("'" + file +
                     "': expected x,y,z or x,y,z,qx,qy,qz,qw, or an existing JSON file");
  }
  const std::string text{std::istreambuf_iterator<char>(in), {}};
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

}  // namespace

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

}  // namespace loopbench::harness
