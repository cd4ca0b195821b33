#include "metrics/evaluation/evaluation.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>

#include "datasets/core/params.hpp"
#include "metrics/trajectory/position_only.hpp"
#include "metrics/trajectory/projection.hpp"
#include "metrics/trajectory/tracking_gaps.hpp"

namespace loopbench::metrics {
namespace {

std::string span_text(double first, double last) {
  return to_text(first) + " .. " + to_text(last) + " s";
}

constexpr double kPause = 2.0;  // [s], as in DiagnosticsOptions

double seconds_in(const std::vector<TrackingGap>& gaps) {
  double sum = 0.0;
  for (const TrackingGap& gap : gaps) sum += gap.end - gap.begin;
  return sum;
}

/// For ascending stamps: whether the stamp lies inside a gap.
class InsideGap {
 public:
  explicit InsideGap(const std::vector<TrackingGap>& gaps) : gaps_(gaps) {}

  bool operator()(double stamp) {
    while (next_ < gaps_.size() && gaps_[next_].end <= stamp) ++next_;
    return next_ < gaps_.size() && gaps_[next_].begin < stamp;
  }

 private:
  const std::vector<TrackingGap>& gaps_;
  std::size_t next_ = 0;
};

/// "reference has no rotations", or how it shows that it holds only positions.
std::string positions_text(const Trajectory& poses, const std::string& whose) {
  if (lacks_rotations(poses)) return whose + " has positions without rotation";
  return whose + " has a constant orientation although its path is curved: it holds only positions";
}

void require_attitudes(const Paired& paired, Align align) {
  if (align != Align::origin && align != Align::posyaw_origin) return;
  const bool is_reference = is_position_only(paired.reference);
  const bool is_estimate = is_position_only(paired.estimate);
  const bool is_lacking = lacks_rotations(paired.reference) || lacks_rotations(paired.estimate);
  if (is_reference == is_estimate && !is_lacking) return;
  throw std::runtime_error("alignment " + to_text(align) + ": the " +
                           positions_text(is_reference ? paired.reference : paired.estimate,
                                          is_reference ? "reference" : "estimate") +
                           ", so its first pose does not define a rotation; align by se3, sim3, "
                           "posyaw or none");
}

/// Normals of both planes, to one side; none if the protocol or the poses are spatial, or if the
/// axes of the two bodies do not tell the sides apart. `yes` moves the poses to their planes.
std::optional<PlaneNormals> common_plane(Paired& paired, const Protocol& protocol) {
  const bool is_fitted = protocol.align == Align::se3 || protocol.align == Align::sim3;
  if (protocol.planar == Planar::no || !is_fitted) return std::nullopt;
  const auto plane = [&](Trajectory& poses) -> std::optional<MotionPlane> {
    if (protocol.planar == Planar::automatic) return motion_plane(poses);
    const MotionPlane nearest = nearest_plane(poses);
    move_to_plane(poses, nearest);
    return nearest;
  };
  const auto of_estimate = plane(paired.estimate);
  if (!of_estimate) return std::nullopt;
  const auto of_reference = plane(paired.reference);
  if (!of_reference) return std::nullopt;
  const bool has_positions =
      is_position_only(paired.reference) || is_position_only(paired.estimate);
  const double side = has_positions ? of_reference->in_world.dot(of_estimate->in_world)
                                    : of_reference->in_body.dot(of_estimate->in_body);
  constexpr double kClear = 0.9;
  if (std::abs(side) < kClear) return std::nullopt;
  return PlaneNormals{of_reference->in_world,
                      std::copysign(1.0, side) * of_estimate->in_world,
                      protocol.planar == Planar::yes};
}

Evaluation align_pairs(Paired paired,
                       std::size_t possible,
                       const Trajectory& reference,
                       const Protocol& protocol) {
  require_attitudes(paired, protocol.align);
  Evaluation out;
  out.protocol = protocol;
  out.reference_length = path_length(reference);
  const auto first = static_cast<std::size_t>(protocol.align_first);
  const auto plane = common_plane(paired, protocol);
  const auto in_plane =
      plane ? align_in_plane(paired.reference, paired.estimate, protocol.align, *plane, first)
            : std::nullopt;
  out.planar = in_plane.has_value();
  out.alignment =
      in_plane ? *in_plane : align(paired.reference, paired.estimate, protocol.align, first);
  out.coverage.pairs = paired.reference.size();
  out.coverage.possible = possible;
  const double duration = reference.back().stamp - reference.front().stamp;
  const double evaluated = paired.reference.back().stamp - paired.reference.front().stamp -
                           uncovered_time(reference, stamps(paired.reference), kPause);
  out.coverage.span = duration > 0.0 ? evaluated / duration : 1.0;
  out.estimate = moved(out.alignment, std::move(paired.estimate));
  out.reference = std::move(paired.reference);
  project(out.reference, protocol.project);
  project(out.estimate, protocol.project);
  return out;
}

std::string limits(const Protocol& protocol) {
  if (interpolates(protocol.association)) {
    const bool is_reference = protocol.association == Association::interpolate;
    return (is_reference ? "reference" : "estimate") + std::string(" gaps of at most ") +
           to_text(protocol.max_gap) + " s";
  }
  return "differences of at most " + to_text(protocol.max_diff) + " s";
}

}  // namespace

Evaluation evaluate(const Trajectory& reference,
                    const Trajectory& estimate,
                    const Protocol& protocol) {
  if (reference.empty()) throw std::runtime_error("the reference has no poses");
  if (estimate.empty()) throw std::runtime_error("the estimate has no poses");
  Paired paired = associate(reference, estimate, protocol);
  if (paired.reference.empty()) {
    throw std::runtime_error(
        "no pose of the estimate (" + span_text(estimate.front().stamp, estimate.back().stamp) +
        ", offset " + to_text(protocol.offset) + " s) matches the reference (" +
        span_text(reference.front().stamp, reference.back().stamp) + "): association " +
        to_text(protocol.association) + " accepts " + limits(protocol));
  }
  const bool is_at_reference = protocol.association == Association::interpolate_estimate;
  const std::size_t possible = is_at_reference ? reference.size() : estimate.size();
  Evaluation out = align_pairs(std::move(paired), possible, reference, protocol);
  if (uses_complete_files(protocol.pairs)) out.complete = {reference, estimate};
  return out;
}

Evaluation evaluate(const Trajectory& reference,
                    const Curve& estimate,
                    const std::vector<double>& keyframe_stamps,
                    Times times,
                    const Protocol& protocol,
                    const std::vector<double>& tracked) {
  if (times == Times::keyframes) {
    return evaluate(reference, estimate.sample(keyframe_stamps), protocol);
  }
  if (reference.empty()) throw std::runtime_error("the reference has no poses");
  const double limit = protocol.max_estimate_gap;
  const std::vector<TrackingGap> gaps = tracking_gaps(reference,
                                                      tracked.empty() ? keyframe_stamps : tracked,
                                                      protocol.offset,
                                                      limit > 0.0 ? limit : kPause);
  InsideGap is_bridged(gaps);
  std::size_t possible = 0;
  Paired paired;
  std::vector<double> wanted;  // the reference's stamps in the estimate's time
  for (const StampedPose& pose : reference) {
    const double stamp = pose.stamp - protocol.offset;
    if (stamp < estimate.start() || stamp > estimate.end()) continue;
    ++possible;
    if (limit > 0.0 && is_bridged(pose.stamp)) continue;
    wanted.push_back(stamp);
    paired.reference.push_back(pose);
  }
  if (wanted.empty()) {
    throw std::runtime_error("no reference stamp (" +
                             span_text(reference.front().stamp, reference.back().stamp) +
                             ") lies on the curve (" + span_text(estimate.start(), estimate.end()) +
                             ", offset " + to_text(protocol.offset) + " s)");
  }
  paired.estimate = estimate.sample(wanted);
  Trajectory complete = uses_complete_files(protocol.pairs) ? paired.estimate : Trajectory();
  Evaluation out = align_pairs(std::move(paired), possible, reference, protocol);
  out.coverage.bridged = seconds_in(gaps);
  if (uses_complete_files(protocol.pairs)) out.complete = {reference, std::move(complete)};
  return out;
}

std::string why_no_attitude(const Evaluation& evaluation) {
  const auto text = [](const Trajectory& poses, const char* whose) {
    return "the " + positions_text(poses, whose) + ", so rotation is not evaluated";
  };
  if (is_position_only(evaluation.reference)) return text(evaluation.reference, "reference");
  if (is_position_only(evaluation.estimate)) return text(evaluation.estimate, "estimate");
  return "";
}

}  // namespace loopbench::metrics
