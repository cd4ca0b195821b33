#include "metrics/rpe.hpp"

#include <cmath>
#include <stdexcept>

#include "datasets/core/parallel.hpp"
#include "metrics/angle.hpp"
#include "metrics/pair_search.hpp"
#include "metrics/position_only.hpp"

namespace loopbench {
namespace {

std::vector<FromTo> pairs(const Evaluation& evaluation, const RpeOptions& o) {
  const double tolerance = o.tolerance * o.delta;
  if (o.unit == DeltaUnit::s) {
    return pairs_by_measure(stamps(evaluation.reference), o.delta, tolerance);
  }
  if (o.unit == DeltaUnit::m) {
    const bool is_reference = o.distance_of == DistanceOf::reference;
    const Trajectory& measured = is_reference ? evaluation.reference : evaluation.estimate;
    return pairs_by_measure(accumulated_distances(measured), o.delta, tolerance);
  }
  if (o.delta != std::floor(o.delta)) {
    throw OptionError("delta", "delta = " + to_text(o.delta) + ": frames come whole");
  }
  const std::size_t n = evaluation.reference.size();
  if (o.delta >= static_cast<double>(n)) return {};
  return pairs_by_frames(n, static_cast<std::size_t>(o.delta));
}

}  // namespace

std::vector<Score> rpe(const Evaluation& evaluation, const RpeOptions& options) {
  const std::vector<FromTo> found = pairs(evaluation, options);
  if (found.empty()) {
    throw std::runtime_error("rpe: none of " + std::to_string(evaluation.reference.size()) +
                             " poses is " + to_text(options.delta) + " " + to_text(options.unit) +
                             " before another");
  }
  std::vector<double> metres(found.size());
  std::vector<double> degrees(found.size());
  std::array<std::vector<double>, 3> axes;
  for (std::vector<double>& axis : axes) axis.resize(found.size());

  const auto judge = [&](std::size_t k) {
    const auto& [i, j] = found[k];
    const Pose& Q_i = evaluation.reference[i].world_from_body;
    const Pose& Q_j = evaluation.reference[j].world_from_body;
    const Pose& P_i = evaluation.estimate[i].world_from_body;
    const Pose& P_j = evaluation.estimate[j].world_from_body;
    const Pose E = (Q_i.inverse() * Q_j).inverse() * (P_i.inverse() * P_j);
    metres[k] = E.translation.norm();
    degrees[k] = kDegrees * log_so3(E.rotation).norm();
    const Vector3 change =
        options.frame == RpeFrame::body
            ? E.translation
            : Vector3((P_j.translation - Q_j.translation) - (P_i.translation - Q_i.translation));
    for (int a = 0; a < 3; ++a) axes[static_cast<std::size_t>(a)][k] = std::abs(change[a]);
  };
  in_blocks(found.size(), [&](std::size_t k, std::size_t end) {
    for (; k < end; ++k) judge(k);
  });
  // |trans(E)| and the body frame turn motions by the attitudes; only the world's axes do not.
  const std::string why = why_no_attitude(evaluation);
  const std::string why_axis = options.frame == RpeFrame::body ? why : "";
  const auto score = [](const char* relation,
                        const char* axis,
                        const char* unit,
                        std::vector<double>& errors,
                        const std::string& why_not) {
    if (!why_not.empty()) return Score{relation, axis, unit, {}, why_not};
    return Score{relation, axis, unit, statistics(std::move(errors))};
  };
  return {score("translation", "3d", "m", metres, why),
          score("translation", "x", "m", axes[0], why_axis),
          score("translation", "y", "m", axes[1], why_axis),
          score("translation", "z", "m", axes[2], why_axis),
          score("rotation", "3d", "deg", degrees, why)};
}

}  // namespace loopbench
