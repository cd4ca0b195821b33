#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include "harness/commands/loops/loops.hpp"

namespace loopbench::harness {
namespace {

/// A line between two positions, then a gap.
void add_line(DrawnCurve& curve, const Vector3& from, const Vector3& to) {
  add_position(curve, from);
  add_position(curve, to);
  add_position(curve, Vector3::Constant(NAN));
}

/// Moves a curve to the figure if it has any lines.
void take_lines(DrawnCurve curve, FigureData& out) {
  if (curve.columns.empty()) return;
  out.curves.push_back(std::move(curve));
}

double map_extent(const Trajectory& poses) {
  Vector3 low = Vector3::Constant(INFINITY), high = -low;
  for (const StampedPose& each : poses) {
    low = low.cwiseMin(each.world_from_body.translation);
    high = high.cwiseMax(each.world_from_body.translation);
  }
  return poses.empty() ? 0.0 : (high - low).maxCoeff();
}

/// Anchors as lines from the measured points of the poses, at least a hundredth of the map long.
void add_anchors(const LoopsResult& result, const Trajectory& poses, FigureData& out) {
  const auto& found = result.ledger.anchors;
  if (!found) return;
  DrawnCurve used{.name = "anchors that agree", .style = 1};
  DrawnCurve dropped{.name = "anchors that disagree", .style = 6};
  const double arm = 0.005 * map_extent(poses);
  for (std::size_t i = 0; i < found->anchors.size(); ++i) {
    const Anchor& anchor = result.problem.anchors[i];
    const Pose& pose = poses[anchor.keyframe].world_from_body;
    const Vector3 point = anchor.position + anchor_error(anchor, pose);
    const bool is_used = found->is_decided && found->anchors[i].agrees;
    const Vector3 least = Vector3::Constant((point - anchor.position).norm() < arm ? arm : 0.0);
    add_line(is_used ? used : dropped, point + least, anchor.position - least);
  }
  take_lines(std::move(used), out);
  take_lines(std::move(dropped), out);
}

}  // namespace

FigureData loops_figure(const LoopsResult& result, const Trajectory& poses, bool with_anchors) {
  const std::string title = std::filesystem::path(result.estimate).filename().string();
  FigureData out{title, "", {{.name = "keyframes"}}, {}, {}};
  add_poses(out.curves[0], poses, 0.0);
  const auto at = [&](std::size_t k) { return poses[k].world_from_body.translation; };
  std::map<std::string, DrawnCurve> kinds{
      // drawn in this order
      {"agrees", {.name = "closures that agree", .style = 2, .dash = 1, .is_thin = true}},
      {"unchecked",
       {.name = "closures that cannot be checked", .style = 4, .dash = 1, .is_thin = true}},
      {"disagrees", {.name = "closures that disagree", .style = 3, .dash = 1, .is_thin = true}},
  };
  for (std::size_t rank = 0; rank < result.ledger.suspects.size(); ++rank) {
    const Edge& edge = result.problem.closures[result.ledger.suspects[rank]];
    add_line(kinds.at(judgement(result, rank)), at(edge.from), at(edge.to));
  }
  for (auto& [kind, curve] : kinds) take_lines(std::move(curve), out);
  if (with_anchors) add_anchors(result, poses, out);
  if (!result.ledger.judgement) return out;
  DrawnCurve freed{.name = "steps of the odometry that are wrong", .dash = 1};
  for (const methods::FreedStep& step : result.ledger.judgement->steps) {
    add_line(freed, at(step.from), at(step.from + 1));
  }
  take_lines(std::move(freed), out);
  return out;
}

}  // namespace loopbench::harness
