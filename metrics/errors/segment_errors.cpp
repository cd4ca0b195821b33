#include "metrics/errors/segment_errors.hpp"

#include <algorithm>
#include <cmath>

#include "datasets/core/parallel.hpp"
#include "metrics/numerics/euler.hpp"
#include "metrics/pairing/motion.hpp"

namespace loopbench::metrics {
namespace {

/// The printed matrices if the protocol evaluates them unchanged, otherwise null.
const PrintedPoses* printed(const Evaluation& evaluation) {
  const Protocol& p = evaluation.protocol;
  const bool is_unmoved = p.association == Association::index && p.align == Align::none &&
                          p.project == ProjectionPlane::none;
  const bool is_kitti = p.form == ErrorForm::kitti && p.angle == AngleFormula::trace;
  return is_unmoved && is_kitti ? evaluation.context.printed : nullptr;
}

PoseMatrix printed_error(const PrintedPoses& poses, std::size_t i, std::size_t j) {
  const auto& [Q, P] = poses;
  return (P[i].inverse() * P[j]).inverse() * (Q[i].inverse() * Q[j]);
}

}  // namespace

SegmentErrors segment_errors(const Evaluation& evaluation,
                             const std::vector<double>& distances,
                             const std::vector<FromTo>& pairs,
                             double length,
                             bool only_rates) {
  const Protocol& protocol = evaluation.protocol;
  const bool is_per_metre_gone = protocol.segments.end == SegmentEnd::eth3d;
  Rotation up_from_reference = Rotation::Identity();
  if (protocol.segments.up == PairsFrom::estimate) {
    up_from_reference = evaluation.alignment.reference_from_estimate.rotation.conjugate();
  }
  const PrintedPoses* const digits = printed(evaluation);
  SegmentErrors out;
  out.translation_share.resize(pairs.size());
  out.rotation_rate.resize(pairs.size());
  for (auto* more : {&out.translation, &out.rotation, &out.yaw, &out.gravity}) {
    if (!only_rates) more->resize(pairs.size());
  }
  const auto set = [&](std::size_t k) {
    const auto& [i, j] = pairs[k];
    const Pose& P_j = evaluation.estimate[j].world_from_body;
    Pose E = motion_error(protocol.form,
                          evaluation.reference[i].world_from_body,
                          evaluation.reference[j].world_from_body,
                          evaluation.estimate[i].world_from_body,
                          P_j);
    double radians = rotation_angle(protocol.angle, E.rotation);
    if (digits != nullptr) {
      const PoseMatrix exact = printed_error(*digits, i, j);
      E.translation = exact.translation();
      radians = trace_angle(exact.linear().trace());
    }
    const double metres = E.translation.norm();
    const double per = is_per_metre_gone ? distances[j] - distances[i] : length;
    out.translation_share[k] = metres / per;
    out.rotation_rate[k] = radians / per;
    if (only_rates) return;
    const Rotation up_from_body = up_from_reference * P_j.rotation;
    const Euler turn = euler(up_from_body * E.rotation * up_from_body.conjugate());
    out.translation[k] = metres;
    out.rotation[k] = radians;
    out.yaw[k] = std::abs(turn.yaw);
    out.gravity[k] = std::hypot(turn.roll, turn.pitch);
  };
  parallel_for_blocks(pairs.size(), [&](std::size_t k, std::size_t end) {
    for (; k < end; ++k) set(k);
  });
  return out;
}

std::vector<float> float_distances(const Trajectory& trajectory) {
  std::vector<float> out{0.0F};
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Vector3 step =
        trajectory[i - 1].world_from_body.translation - trajectory[i].world_from_body.translation;
    const auto dx = static_cast<float>(step.x());
    const auto dy = static_cast<float>(step.y());
    const auto dz = static_cast<float>(step.z());
    out.push_back(out.back() + std::sqrt(dx * dx + dy * dy + dz * dz));
  }
  return out;
}

SegmentErrors float_segment_errors(const Evaluation& evaluation,
                                   const std::vector<FromTo>& pairs,
                                   float length) {
  const PrintedPoses* const digits = printed(evaluation);
  SegmentErrors out;
  for (const auto& [i, j] : pairs) {
    PoseMatrix E;
    if (digits != nullptr) {
      E = printed_error(*digits, i, j);
    } else {
      const Pose rigid = motion_error(ErrorForm::kitti,
                                      evaluation.reference[i].world_from_body,
                                      evaluation.reference[j].world_from_body,
                                      evaluation.estimate[i].world_from_body,
                                      evaluation.estimate[j].world_from_body);
      E.linear() = rigid.rotation.toRotationMatrix();
      E.translation() = rigid.translation;
    }
    const auto a = static_cast<float>(E(0, 0));
    const auto b = static_cast<float>(E(1, 1));
    const auto c = static_cast<float>(E(2, 2));
    const auto cosine = static_cast<float>(0.5 * (static_cast<double>(a + b + c) - 1.0));
    const float radians = std::acos(std::max(std::min(cosine, 1.0F), -1.0F));
    const auto dx = static_cast<float>(E.translation().x());
    const auto dy = static_cast<float>(E.translation().y());
    const auto dz = static_cast<float>(E.translation().z());
    const float metres = std::sqrt(dx * dx + dy * dy + dz * dz);
    out.start.push_back(i);
    out.translation_share.push_back(static_cast<double>(metres / length));
    out.rotation_rate.push_back(static_cast<double>(radians / length));
  }
  return out;
}

double float_mean(const std::vector<double>& values) {
  float sum = 0.0F;
  for (const double value : values) sum += static_cast<float>(value);
  return static_cast<double>(sum / static_cast<float>(values.size()));
}

}  // namespace loopbench::metrics
