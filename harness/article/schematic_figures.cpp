#include "harness/article/schematic_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "harness/article/true_keyframes.hpp"
#include "harness/plot/gnuplot.hpp"
#include "methods/smoothers/manifold/psi.hpp"

namespace loopbench::harness {
namespace {

using methods::manifold::angle_between_directions;
using methods::manifold::Nodes;
using methods::manifold::NodeSpline;

constexpr const char* kTrueColor = "#d62728";
constexpr const char* kEstimateColor = "#1f4fd6";
constexpr const char* kOtherColor = "#2ca02c";
constexpr const char* kFaintColor = "#888888";
constexpr double kPerRadian = 180.0 / std::numbers::pi;

/// The reference at the keyframes, and four of its nodes around a bend.
struct Bend {
  explicit Bend(const PaperCell& raw)
      : keyframes(true_keyframes(raw)), nodes(keyframes), spline(nodes) {
    double largest = 0.0;
    for (std::size_t i = 3; i + 3 < nodes.size(); ++i) {
      const double angle = angle_between_directions(nodes.step(i - 1), nodes.step(i));
      if (angle <= largest || angle > 0.25 * std::numbers::pi) continue;
      largest = angle;
      node = i;
    }
    for (const StampedPose& pose : raw.dense.reference) {
      const bool is_in =
          pose.stamp >= nodes.stamps[node - 1] && pose.stamp <= nodes.stamps[node + 2];
      if (is_in) path.push_back(pose.world_from_body.translation);
    }
  }

  Vector3 at(std::size_t i) const { return nodes.base + nodes.points[i]; }
  std::vector<Vector3> corners() const {
    return {at(node - 1), at(node), at(node + 1), at(node + 2)};
  }
  double step() const { return nodes.step(node).norm(); }
  Vector3 binormal(std::size_t i) const {
    return nodes.step(i - 1).cross(nodes.step(i)).normalized();
  }

  Trajectory keyframes;
  Nodes nodes;
  NodeSpline spline;
  std::size_t node = 3;
  std::vector<Vector3> path;
};

PlotSeries arrow(const std::string& name,
                 const char* color,
                 const Vector3& from,
                 const Vector3& along,
                 double width) {
  return {name, color, false, {from, from + along}, width};
}

PlotPanel spatial_panel(const std::string& title, std::vector<PlotSeries> series) {
  PlotPanel out;
  out.title = title;
  out.spatial = true;
  out.series = std::move(series);
  return out;
}

std::vector<Vector3> path_of(const Trajectory& poses) {
  std::vector<Vector3> out;
  for (const StampedPose& pose : poses) out.push_back(pose.world_from_body.translation);
  return thinned(out, 600);
}

std::vector<PlotPanel> drift_and_joints(const PaperCell& open, const Bend& bend) {
  PlotPanel drift;
  drift.title = "(a) fr1_room open: drift";
  drift.series = {
      {"real path", kTrueColor, false, path_of(open.dense.reference), 2.5},
      {"image matching alone", kEstimateColor, false, path_of(open.dense.estimate), 1.2}};
  std::vector<Vector3> smooth;
  for (std::size_t edge = bend.node - 1; edge <= bend.node + 1; ++edge) {
    for (int k = 0; k <= 20; ++k) {
      const double t = bend.nodes.stamps[edge] + 0.05 * k * bend.nodes.duration(edge);
      smooth.push_back(bend.nodes.base + bend.spline.at(edge, t).point);
    }
  }
  PlotPanel joints = spatial_panel("(b) C0 (straight lines) and C1 (spline) at keyframes",
                                   {{"C1", kEstimateColor, false, smooth, 1.6},
                                    {"C0", kFaintColor, false, bend.corners(), 1.2},
                                    {"keyframes", "#000000", true, bend.corners()}});
  return {drift, joints};
}

PlotPanel frenet_panel(const Bend& bend) {
  const Vector3 tangent =
      bend.spline.at(bend.node, methods::manifold::time_jet(bend.nodes.stamps[bend.node]))
          .point.first.normalized();
  const Vector3 binormal = bend.binormal(bend.node);
  const Vector3 p = bend.at(bend.node);
  const double size = 0.5 * bend.step();
  return spatial_panel("nodes 1 to 4, {T, N, B} at node 2",
                       {{"real", kTrueColor, false, bend.path, 2.5},
                        {"straight lines", kEstimateColor, false, bend.corners(), 1.2},
                        {"nodes", "#000000", true, bend.corners()},
                        arrow("T", kOtherColor, p, size * tangent, 3.0),
                        arrow("N", "#9467bd", p, size * binormal.cross(tangent).normalized(), 3.0),
                        arrow("B", "#ff7f0e", p, size * binormal, 3.0)});
}

PlotPanel psi_panel(const Bend& bend, double& angle) {
  const std::vector<Vector3> candidates =
      methods::manifold::candidates(bend.nodes, bend.spline, bend.node, 2);
  const Vector3 psi = methods::manifold::optimal_tangent(
      bend.nodes, bend.spline, bend.node, 2, methods::manifold::PsiMean::discrete);
  const Vector3 p = bend.at(bend.node);
  std::vector<PlotSeries> series{{"S", kTrueColor, false, bend.path, 2.5}};
  angle = 0.0;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    series.push_back(
        arrow(fmt::format("psi_{}", k + 1), kFaintColor, p, bend.step() * candidates[k], 1.2));
    angle = std::max(angle, angle_between_directions(candidates[k], psi));
  }
  series.push_back(arrow("psi", kEstimateColor, p, 1.2 * bend.step() * psi, 3.0));
  return spatial_panel("candidates and the optimal tangent psi at p", std::move(series));
}

PlotPanel torsion_panel(const Bend& bend) {
  const double size = 0.6 * bend.step();
  return spatial_panel(
      "binormals at P(t) and P(t + dt)",
      {{"S", kTrueColor, false, bend.path, 2.5},
       {"nodes", "#000000", true, {bend.at(bend.node), bend.at(bend.node + 1)}},
       arrow("B(t)", kEstimateColor, bend.at(bend.node), size * bend.binormal(bend.node), 3.0),
       arrow("B(t + dt)",
             kOtherColor,
             bend.at(bend.node + 1),
             size * bend.binormal(bend.node + 1),
             3.0),
       arrow("B(t) moved",
             kFaintColor,
             bend.at(bend.node + 1),
             size * bend.binormal(bend.node),
             1.2)});
}

}  // namespace

std::vector<PaperFigure> schematic_figures(const std::vector<PaperCell>& cells,
                                           const std::filesystem::path& folder) {
  PaperCell like;
  like.sequence = "fr1_room";
  like.input = "closed";
  const PaperCell* closed = find_cell(cells, like, "", "ORB_SLAM2");
  like.input = "open";
  const PaperCell* open = find_cell(cells, like, "", "ORB_SLAM2");
  const auto is_usable = [](const PaperCell* cell) {
    return cell != nullptr && cell->keyframes.size() > 8 && !cell->dense.reference.empty();
  };
  if (!is_usable(closed) || !is_usable(open)) return {};
  const Bend bend(*closed);
  double widest = 0.0;
  const PlotPanel psi = psi_panel(bend, widest);
  const double turn =
      angle_between_directions(bend.nodes.step(bend.node - 1), bend.nodes.step(bend.node));
  const double torsion =
      angle_between_directions(bend.binormal(bend.node), bend.binormal(bend.node + 1));
  write_figure(folder / "figure1.svg", drift_and_joints(*open, bend), 2);
  write_figure(folder / "figure2.svg", {frenet_panel(bend)}, 1);
  write_figure(folder / "figure3.svg", {psi}, 1);
  write_figure(folder / "figure4.svg", {torsion_panel(bend)}, 1);
  return {
      {"figure1.svg",
       "**Figure 1.** (a) the estimate without loop closing drifts from the real path; (b) "
       "keyframes "
       "joined with C0 and C1.\n"},
      {"figure2.svg",
       fmt::format(
           "**Figure 2.** Four keyframes of the reference, the real motion between them, and "
           "the Frenet frame at a node with kappa {:.2f} rad per keyframe.\n",
           turn)},
      {"figure3.svg",
       fmt::format(
           "**Figure 3.** Candidates of psi (chords, principal axis, spline tangent) and the "
           "one chosen; the widest is {:.1f} deg from it.\n",
           kPerRadian * widest)},
      {"figure4.svg",
       fmt::format(
           "**Figure 4.** Binormals at neighbouring nodes; the angle between them is {:.1f} "
           "deg.\n",
           kPerRadian * torsion)},
  };
}

}  // namespace loopbench::harness
