#include "datasets/formats/json_graph.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "datasets/columns/pose_matrix.hpp"
#include "datasets/compressed/input_file.hpp"
#include "datasets/formats/json_graph_builder.hpp"

namespace loopbench {
namespace {

using GraphJson = nlohmann::json;

constexpr std::size_t kLargestGraph = std::size_t{1} << 30;  // [bytes]

const GraphJson& member(const JsonPlace& at, const GraphJson& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  if (!object.is_object() || found == object.end()) {
    throw at.error(std::string("has no \"") + key + "\"");
  }
  return *found;
}

double json_number(const JsonPlace& at, const GraphJson& object, const char* key) {
  const GraphJson& value = member(at, object, key);
  if (!value.is_number()) throw at.error(std::string("\"") + key + "\" is no number");
  return value.get<double>();
}

/// Keys are identified as the numbers that GTSAM writes.
std::int64_t key_of(const JsonPlace& at, const std::string& text) {
  std::int64_t out = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, out);
  if (error == std::errc{} && rest == end && out >= 0) return out;
  throw at.error("key " + text.substr(0, 40) +
                 ": keys are numbers of GTSAM, from 0 to 2^63 - 1: letter * 2^56 + index, or an "
                 "index");
}

std::int64_t json_id(const JsonPlace& at, const GraphJson& object, const char* key) {
  const GraphJson& value = member(at, object, key);
  if (!value.is_number_integer()) throw at.error(std::string("\"") + key + "\" is no integer");
  return key_of(at, value.dump());
}

/// A list of N numbers.
template <int N>
Eigen::Matrix<double, N, 1> json_list(const JsonPlace& at,
                                      const GraphJson& object,
                                      const char* key) {
  const GraphJson& value = member(at, object, key);
  Eigen::Matrix<double, N, 1> out;
  if (!value.is_array() || value.size() != N ||
      !std::ranges::all_of(value, [](const GraphJson& each) { return each.is_number(); })) {
    throw at.error(std::string("\"") + key + "\" is not a list of " + std::to_string(N) +
                   " numbers");
  }
  for (int i = 0; i < N; ++i) out[i] = value[static_cast<std::size_t>(i)].get<double>();
  return out;
}

Pose open3d_pose(const JsonPlace& at, const GraphJson& object, const char* key) {
  const Eigen::Matrix<double, 16, 1> values = json_list<16>(at, object, key);
  PoseMatrix matrix;
  matrix.matrix() = Eigen::Map<const Eigen::Matrix4d>(values.data()).topRows<3>();
  ReadFindings unused;
  if (const std::string why = normalise_matrix(matrix, unused); !why.empty()) throw at.error(why);
  return {Rotation(Matrix3(matrix.linear())).normalized(), matrix.translation()};
}

PoseGraph read_open3d(const std::string& name,
                      const GraphJson& json,
                      const InformationRules& rules) {
  GraphBuilder out(name, rules);
  std::int64_t count = 0;
  for (const GraphJson& node : member(out.place("graph"), json, "nodes")) {
    out.add_vertex(count, open3d_pose(out.place("node " + std::to_string(count)), node, "pose"));
    ++count;
  }
  std::size_t k = 0;
  for (const GraphJson& edge : member(out.place("graph"), json, "edges")) {
    const JsonPlace at = out.place("edge " + std::to_string(k++));
    const std::int64_t source = json_id(at, edge, "source_node_id");
    const std::int64_t target = json_id(at, edge, "target_node_id");
    if (std::min(source, target) < 0 || std::max(source, target) >= count) {
      throw at.error("refers to a node that does not exist");
    }
    out.add_edge(at,
                 target,
                 source,
                 open3d_pose(at, edge, "transformation"),
                 translations_first(json_list<36>(at, edge, "information")));
  }
  return out.graph();
}

/// A value Pose2 or Pose3.
Pose jrl_pose(const JsonPlace& at, const GraphJson& value) {
  if (member(at, value, "type") == "Pose2") {
    return {exp_so3({0.0, 0.0, json_number(at, value, "theta")}),
            {json_number(at, value, "x"), json_number(at, value, "y"), 0.0}};
  }
  const Eigen::Vector4d q = json_list<4>(at, value, "rotation");  // w, x, y, z
  if (!(std::abs(q.norm() - 1.0) < 1e-3)) throw at.error("quaternion is not unit");
  return {Rotation(q[0], q[1], q[2], q[3]).normalized(), json_list<3>(at, value, "translation")};
}

/// Inverse of the covariance, as information of a twist.
Matrix6 jrl_information(const JsonPlace& at, const GraphJson& factor, bool planar) {
  if (planar) {
    const Eigen::Matrix<double, 9, 1> values = json_list<9>(at, factor, "covariance");
    return lift_planar(Matrix3(Eigen::Map<const Matrix3>(values.data())).inverse());
  }
  return inverse_of(translations_first(json_list<36>(at, factor, "covariance")));
}

void add_factor(GraphBuilder& out,
                const JsonPlace& at,
                const GraphJson& factor,
                std::optional<bool>& planar) {
  const GraphJson& type = member(at, factor, "type");
  const std::string word = type.is_string() ? type.get<std::string>() : "";
  const bool is_edge = word.starts_with("BetweenFactorPose");
  const bool is_prior = word.starts_with("PriorFactorPose");
  if (!is_edge && !is_prior) return out.skip(word);
  const bool is_planar = word.ends_with("Pose2");
  if (planar.value_or(is_planar) != is_planar) {
    throw at.error("is planar in a graph that is not, or not in one that is");
  }
  planar = is_planar;
  const Matrix6 information = jrl_information(at, factor, is_planar);
  if (is_edge) {
    out.add_edge(at,
                 json_id(at, factor, "key1"),
                 json_id(at, factor, "key2"),
                 jrl_pose(at, member(at, factor, "measurement")),
                 information);
    return;
  }
  const Pose pose = jrl_pose(at, member(at, factor, "prior"));
  const Matrix3 R = pose.rotation.toRotationMatrix();
  const Matrix3 covariance = R * information.inverse().topLeftCorner<3, 3>() * R.transpose();
  out.add_prior(
      json_id(at, factor, "key"),
      {.position = pose.translation, .covariance = 0.5 * (covariance + covariance.transpose())});
}

PoseGraph read_jrl(const std::string& name, const GraphJson& json, const InformationRules& rules) {
  GraphBuilder out(name, rules);
  std::optional<bool> planar;
  for (const auto& [robot, entries] : member(out.place("log"), json, "measurements").items()) {
    std::size_t row = 0;
    for (const GraphJson& entry : entries) {
      const JsonPlace at = out.place("robot " + robot + ", entry " + std::to_string(row++));
      for (const GraphJson& factor : member(at, entry, "measurements")) {
        add_factor(out, at, factor, planar);
      }
    }
  }
  if (const auto initial = json.find("initialization"); initial != json.end()) {
    for (const auto& [robot, values] : initial->items()) {
      for (const auto& [key, value] : values.items()) {
        const JsonPlace at = out.place("initialization of " + robot + ", key " + key.substr(0, 40));
        const GraphJson& type = member(at, value, "type");
        if (type != "Pose2" && type != "Pose3") continue;
        out.add_vertex(key_of(at, key), jrl_pose(at, value));
      }
    }
  }
  out.set_planar(planar.value_or(false));
  return out.graph();
}

}  // namespace

bool is_json_graph(const std::filesystem::path& file) {
  const OpenedFile in = open_input(file);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> handle(std::fopen(in.path.c_str(), "rb"),
                                                               std::fclose);
  std::array<char, 4096> start{};
  const std::size_t count =
      handle ? std::fread(start.data(), 1, start.size(), handle.get()) : std::size_t{0};
  const std::string_view text(start.data(), count);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == text.npos || text[first] != '{') return false;
  if (text.find("\"PoseGraph\"") != text.npos || text.find("\"PoseGraphEdge\"") != text.npos) {
    return true;
  }
  const std::size_t begin = text.find('"', first) + 1;
  const std::string_view key = text.substr(begin, text.find('"', begin) - begin);
  constexpr std::array<std::string_view, 7> kKeys{"groundtruth",
                                                  "initialization",
                                                  "measurements",
                                                  "name",
                                                  "outlier_factors",
                                                  "potential_outlier_factors",
                                                  "robots"};
  const bool has_factors = text.find("Factor") != text.npos || text.find("\"Pose") != text.npos ||
                           text.find("\"measurements\"") != text.npos;
  return has_factors && std::ranges::find(kKeys, key) != kKeys.end();
}

PoseGraph read_json_graph(const std::filesystem::path& file, const InformationRules& rules) {
  const std::string name = file.string();
  const GraphJson json =
      GraphJson::parse(read_named_file(file, kLargestGraph, "a JSON file"), nullptr, false);
  if (json.is_discarded()) throw input_error(name, 0, "is not valid JSON");
  return json.contains("nodes") ? read_open3d(name, json, rules) : read_jrl(name, json, rules);
}

}  // namespace loopbench
