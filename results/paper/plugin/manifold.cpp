/// The module paper_manifold: building blocks of the manifold smoother on numpy arrays, for
/// article/manifold.py.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>

#include "datasets/core/fields.hpp"
#include "harness/python/arrays.hpp"
#include "methods/smoothers/manifold/dm.hpp"
#include "methods/smoothers/manifold/families/graph.hpp"
#include "methods/smoothers/manifold/fit_axes.hpp"
#include "methods/smoothers/manifold/planar.hpp"
#include "methods/smoothers/manifold/psi.hpp"
#include "methods/smoothers/manifold/segments.hpp"

namespace py = pybind11;

namespace loopbench::paper {
namespace {

using namespace methods::manifold;
using python::Array;

Array rows_of(const std::vector<Vector3>& vectors) {
  Array out({vectors.size(), std::size_t{3}});
  double* at = out.mutable_data();
  for (const Vector3& each : vectors) at = std::copy_n(each.data(), 3, at);
  return out;
}

Array array_of(const Vector3& vector) { return Array(3, vector.data()); }

std::size_t node_in(std::size_t index, std::size_t limit, const char* name) {
  if (index < limit) return index;
  throw InputError(std::string(name) + ": found " + std::to_string(index) +
                   ", expected less than " + std::to_string(limit));
}

Trajectory at_least_two(const Array& rows) {
  Trajectory out = python::read_rows(rows, "keyframes").poses;
  check(out, "keyframes");
  if (out.size() < 2) throw InputError("keyframes: expected at least two");
  return out;
}

/// Keyframes as nodes, with the natural cubic spline through them.
class KeyframePath {
 public:
  explicit KeyframePath(const Array& keyframes)
      : nodes_(at_least_two(keyframes)), spline_(nodes_) {}

  std::vector<double> curvatures() const {
    return kappas(nodes_, Kappa::turn_per_kf, CurveSpace::space, Vector3::UnitZ());
  }

  std::vector<std::pair<std::size_t, std::size_t>> segments(double speed_band,
                                                            double turn_max) const {
    std::vector<std::pair<std::size_t, std::size_t>> out;
    for (const NodeRange& each : methods::manifold::segments(nodes_, {speed_band, turn_max})) {
      out.emplace_back(each.first, each.last);
    }
    return out;
  }

  Array spline(const std::vector<double>& times) const {
    std::vector<Vector3> out;
    for (const double time : times)
      out.push_back(nodes_.base + spline_.at(edge_at(time), time).point);
    return rows_of(out);
  }

  Array velocity(std::size_t node) const {
    node_in(node, nodes_.size() - 1, "node");
    return array_of(spline_.at(node, time_jet(nodes_.stamps[node])).point.first);
  }

  Array tangent_candidates(std::size_t node, std::size_t half) const {
    return rows_of(candidates(nodes_, spline_, node_in(node, nodes_.size(), "node"), half));
  }

  Array optimal_tangent(std::size_t node, std::size_t half, const std::string& mean) const {
    PsiMean chosen = PsiMean::discrete;
    FieldType<PsiMean>::assign("mean", chosen, mean);
    return array_of(methods::manifold::optimal_tangent(
        nodes_, spline_, node_in(node, nodes_.size(), "node"), half, chosen));
  }

  bool admits_window(std::size_t first, std::size_t count) const {
    const Vector3 up = Vector3::UnitZ();
    const PlanarRule rule{.size = count};
    return WindowFitter{nodes_, spline_, up, rule}.admits(window(first, count));
  }

  std::optional<Array> fit_window(std::size_t first,
                                  std::size_t count,
                                  const std::string& family,
                                  const std::vector<double>& times) const {
    const Vector3 up = Vector3::UnitZ();
    const PlanarRule rule{.size = count};
    const auto piece =
        WindowFitter{nodes_, spline_, up, rule}.fit(window(first, count), read_families(family));
    if (!piece) return std::nullopt;
    std::vector<Vector3> out;
    for (const double time : times) {
      out.push_back(nodes_.base + value_of_piece(*piece, spline_.at(edge_at(time), time)));
    }
    return rows_of(out);
  }

 private:
  Window window(std::size_t first, std::size_t count) const {
    if (count < 2) throw InputError("count: expected at least 2");
    node_in(first + count - 1, nodes_.size(), "last node");
    const NodeRange range{first, first + count - 1};
    return {range, range};
  }

  /// The edge that contains the time; the earlier one at a node.
  std::size_t edge_at(double time) const {
    if (!(time >= nodes_.stamps.front() && time <= nodes_.stamps.back())) {
      throw InputError("times: found " + std::to_string(time) + " s, outside the keyframes");
    }
    const auto after = std::lower_bound(nodes_.stamps.begin() + 1, nodes_.stamps.end(), time);
    return static_cast<std::size_t>(after - nodes_.stamps.begin()) - 1;
  }

  Nodes nodes_;
  NodeSpline spline_;
};

/// Nodes where pieces meet that are not joined, with the tangents before and after.
py::tuple free_joints(const Array& keyframes, std::size_t nodes_per_window) {
  Problem problem;
  problem.keyframes = at_least_two(keyframes);
  methods::Report unused;
  const auto curve = methods::Dm({.planar = static_cast<int>(nodes_per_window),
                                  .gap = {{}, {}},
                                  .up = UpDirection::world_z,
                                  .joint = {.kind = JointKind::none}})
                         .fit(problem, unused, {});
  std::vector<std::size_t> joints;
  std::vector<Vector3> before, after;
  for (std::size_t i = 1; curve && i + 1 < problem.keyframes.size(); ++i) {
    const std::vector<std::uint32_t>& piece = curve->parts().planar->piece_of_edge;
    if (piece[i - 1] == piece[i]) continue;
    joints.push_back(i);
    before.push_back(curve->motion(i - 1, problem.keyframes[i].stamp).first);
    after.push_back(curve->motion(i, problem.keyframes[i].stamp).first);
  }
  return py::make_tuple(joints, rows_of(before), rows_of(after));
}

/// Upward direction of cameras that are carried level.
Array level_up(const Array& keyframes) {
  return array_of(level_axes(at_least_two(keyframes)).conjugate() * Vector3::UnitZ());
}

Array least_variance_axis(const Array& keyframes) {
  return array_of(up_axis(at_least_two(keyframes), UpDirection::pca));
}

}  // namespace
}  // namespace loopbench::paper

PYBIND11_MODULE(paper_manifold, module) {
  using namespace loopbench;
  using namespace loopbench::paper;
  py::register_local_exception<InputError>(module, "InputError", PyExc_ValueError);
  py::class_<KeyframePath>(module, "KeyframePath")
      .def(py::init<const Array&>())
      .def("curvatures", &KeyframePath::curvatures)
      .def("segments", &KeyframePath::segments)
      .def("spline", &KeyframePath::spline)
      .def("velocity", &KeyframePath::velocity)
      .def("tangent_candidates", &KeyframePath::tangent_candidates)
      .def("optimal_tangent", &KeyframePath::optimal_tangent)
      .def("admits_window", &KeyframePath::admits_window)
      .def("fit_window", &KeyframePath::fit_window);
  module.def("free_joints", &free_joints);
  module.def("level_up", &level_up);
  module.def("least_variance_axis", &least_variance_axis);
}
