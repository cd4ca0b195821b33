#include "datasets/formats/rtabmap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <set>
#include <utility>

#include "datasets/bags/messages.hpp"
#include "datasets/bags/sqlite_file.hpp"
#include "datasets/core/fields.hpp"
#include "datasets/formats/definite_information.hpp"
#include "datasets/formats/g2o_information.hpp"

namespace loopbench {
namespace {

template <class Number, std::size_t N>
std::optional<std::array<Number, N>> numbers_of(std::string_view bytes) {
  std::array<Number, N> out{};
  if (bytes.size() != sizeof(out)) return std::nullopt;
  std::memcpy(out.data(), bytes.data(), sizeof(out));
  return out;
}

/// Nothing for other sizes and for a transform that is null, as RTAB-Map stores a lost pose.
std::optional<Pose> transform_of(std::string_view bytes) {
  const auto v = numbers_of<float, 12>(bytes);
  if (!v || std::ranges::all_of(*v, [](float x) { return x == 0.0F; })) return std::nullopt;
  Matrix3 R;
  Vector3 t;
  for (Eigen::Index r = 0; r < 3; ++r) {
    for (Eigen::Index c = 0; c < 3; ++c) R(r, c) = (*v)[static_cast<std::size_t>(4 * r + c)];
    t[r] = (*v)[static_cast<std::size_t>(4 * r + 3)];
  }
  constexpr double kTolerance = 1e-3;
  const bool is_rotation = R.allFinite() && t.allFinite() &&
                           (R * R.transpose() - Matrix3::Identity()).norm() < kTolerance &&
                           R.determinant() > 0.0;
  if (!is_rotation) return std::nullopt;
  return Pose{Rotation(R).normalized(), t};
}

struct MapNode {
  std::int64_t id = 0;
  double stamp = 0.0;
  Pose pose;
};

SqliteFile opened_map(const OpenedFile& file) {
  SqliteFile db = open_sqlite(file);
  if (!has_tables(db, {"Node", "Link"})) {
    throw file.error("has no tables Node and Link, expected a database of RTAB-Map");
  }
  return db;
}

/// By ascending id.
std::vector<MapNode> nodes_of(const SqliteFile& db, const OpenedFile& file) {
  std::vector<MapNode> out;
  const SqliteQuery query =
      prepared(db, "SELECT id, stamp, pose FROM Node WHERE id > 0 ORDER BY id");
  while (step(query) == SqliteStep::row) {
    const auto pose = transform_of(blob(query, 2));
    const double stamp = real(query, 1);
    if (pose) out.push_back({integer(query, 0), stamp, *pose});
  }
  if (out.empty()) {
    throw file.error(
        "has no node with a pose of 12 float32, expected a map of RTAB-Map 0.11 or later");
  }
  return out;
}

std::optional<std::size_t> index_of(const std::vector<MapNode>& nodes, std::int64_t id) {
  const auto found = std::ranges::lower_bound(nodes, id, {}, &MapNode::id);
  if (found == nodes.end() || found->id != id) return std::nullopt;
  return static_cast<std::size_t>(found - nodes.begin());
}

Edge edge_of(const SqliteQuery& query, const std::string& where) {
  const auto moved = transform_of(blob(query, 2));
  if (!moved) throw InputError(where + "transform is not the 12 float32 of a rigid transform");
  const auto information = numbers_of<double, 36>(blob(query, 3));
  if (!information) throw InputError(where + "information_matrix has not 36 float64");
  Edge out;
  out.from_from_to = *moved;
  const Matrix6 given = Eigen::Map<const Matrix6>(information->data());
  out.information = 0.5 * (given + given.transpose());
  if (is_positive_definite(out.information)) return out;
  throw InputError(where + "information is not positive definite");
}

}  // namespace

bool is_rtabmap(const OpenedFile& file) {
  return bag_kind(file) == BagKind::db3 && has_tables(open_sqlite(file), {"Node", "Link"});
}

TrajectoryFile read_rtabmap_poses(const std::filesystem::path& file, const ReadOptions& options) {
  const OpenedFile input = open_input(file);
  std::vector<MapNode> nodes = nodes_of(opened_map(input), input);
  std::ranges::stable_sort(nodes, {}, &MapNode::stamp);
  TrajectoryFile out{.poses = {}, .format = Format::csv};
  for (const MapNode& node : nodes) {
    const bool repeats = !out.poses.empty() && out.poses.back().stamp == node.stamp;
    if (repeats && options.repeats == Repeats::refuse) {
      throw input.error(
          fmt::format("nodes up to {} have the stamp {} twice, expected increasing stamps",
                      node.id,
                      to_text(node.stamp)));
    }
    if (repeats && options.repeats == Repeats::keep_first) continue;
    if (repeats && options.repeats == Repeats::keep_last) out.poses.pop_back();
    out.poses.push_back({node.stamp, node.pose});
  }
  return out;
}

PoseGraph read_rtabmap_graph(const std::filesystem::path& file) {
  const OpenedFile input = open_input(file);
  const SqliteFile db = opened_map(input);
  const std::vector<MapNode> nodes = nodes_of(db, input);
  PoseGraph out;
  for (const MapNode& node : nodes) {
    out.ids.push_back(node.id);
    out.vertices.push_back(node.pose);
  }
  constexpr int kLastClosure = 4;  // types: 0 and 6 neighbours, 1 to 4 closures
  constexpr int kMergedNeighbour = 6;
  const SqliteQuery query = prepared(
      db, "SELECT from_id, to_id, transform, information_matrix, type FROM Link ORDER BY rowid");
  std::set<std::pair<std::size_t, std::size_t>> known;
  std::size_t row = 0;
  while (step(query) == SqliteStep::row) {
    ++row;
    const std::int64_t type = integer(query, 4);
    const auto from = index_of(nodes, integer(query, 0));
    const auto to = index_of(nodes, integer(query, 1));
    const bool is_wanted = type <= kLastClosure || type == kMergedNeighbour;
    if (!is_wanted || !from || !to || *from == *to) continue;
    if (!known.insert(std::minmax(*from, *to)).second) continue;
    Edge edge = edge_of(query, fmt::format("{}: row {} of Link: ", input.name, row));
    edge.from = *from, edge.to = *to;
    if (edge.from > edge.to) edge = inverted(edge);
    out.edges.push_back(edge);
    out.lines.push_back(row);
  }
  return out;
}

}  // namespace loopbench
