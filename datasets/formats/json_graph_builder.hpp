/// A pose graph that is built from entries of a file in any order.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "datasets/core/error.hpp"
#include "datasets/core/problem.hpp"
#include "datasets/formats/g2o.hpp"
#include "datasets/formats/g2o_information.hpp"

namespace loopbench {

/// An entry of the file, for messages.
struct JsonPlace {
  std::string file;
  std::string entry;

  InputError error(const std::string& what) const {
    return input_error(file, 0, entry + ": " + what);
  }
};

/// Sorts ids, adds their vertices if all are known, and makes edges refer to them.
class GraphBuilder {
 public:
  GraphBuilder(std::string file, const InformationRules& rules)
      : file_(std::move(file)), rules_(rules) {}

  JsonPlace place(const std::string& entry) const { return {file_, entry}; }

  void add_vertex(std::int64_t id, const Pose& pose) { vertices_[id] = pose; }

  /// With information that may have to be made positive definite.
  void add_edge(const JsonPlace& at,
                std::int64_t from,
                std::int64_t to,
                const Pose& from_from_to,
                const Matrix6& information) {
    if (from == to) throw at.error("connects vertex " + id_text(from) + " to itself");
    Edge edge;
    edge.from_from_to = from_from_to;
    edge.information = definite(at, information);
    ends_.emplace_back(from, to);
    out_.edges.push_back(edge);
    out_.lines.push_back(0);
  }

  void add_prior(std::int64_t id, Anchor anchor) { priors_.emplace_back(id, std::move(anchor)); }

  void skip(const std::string& kind) { ++out_.skipped[kind]; }
  void set_planar(bool planar) { out_.planar = planar; }

  PoseGraph graph() {
    for (const auto& [from, to] : ends_) out_.ids.insert(out_.ids.end(), {from, to});
    for (const auto& [id, pose] : vertices_) out_.ids.push_back(id);
    std::ranges::sort(out_.ids);
    out_.ids.erase(std::unique(out_.ids.begin(), out_.ids.end()), out_.ids.end());
    if (out_.edges.empty()) throw input_error(file_, 0, "contains no edges between poses");
    if (vertices_.size() == out_.ids.size()) {
      for (const auto& [id, pose] : vertices_) out_.vertices.push_back(pose);
    }
    for (std::size_t k = 0; k < ends_.size(); ++k) {
      Edge& edge = out_.edges[k];
      edge.from = index(ends_[k].first);
      edge.to = index(ends_[k].second);
      if (edge.from > edge.to) edge = inverted(edge);
    }
    for (auto& [id, anchor] : priors_) {
      if (!std::ranges::binary_search(out_.ids, id)) continue;
      anchor.keyframe = index(id);
      out_.priors.push_back(std::move(anchor));
    }
    return std::move(out_);
  }

 private:
  std::size_t index(std::int64_t id) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(out_.ids, id) - out_.ids.begin());
  }

  Matrix6 definite(const JsonPlace& at, const Matrix6& written) {
    const Matrix6 information = 0.5 * (written + written.transpose());
    if (is_positive_definite(information)) return information;
    ++out_.altered;
    if (const auto made = made_definite<6>(information, rules_.indefinite)) return *made;
    throw at.error("information is not positive definite (option indefinite: project)");
  }

  std::string file_;
  InformationRules rules_;
  PoseGraph out_;
  std::map<std::int64_t, Pose> vertices_;
  std::vector<std::pair<std::int64_t, std::int64_t>> ends_;
  std::vector<std::pair<std::int64_t, Anchor>> priors_;
};

/// With rotations first as in Open3D and GTSAM, to the order of a twist.
inline Matrix6 translations_first(const Eigen::Matrix<double, 36, 1>& values) {
  const Eigen::Map<const Matrix6> of(values.data());
  Matrix6 out;
  out << of.bottomRightCorner<3, 3>(), of.bottomLeftCorner<3, 3>(), of.topRightCorner<3, 3>(),
      of.topLeftCorner<3, 3>();
  return out;
}

}  // namespace loopbench
