#include "metrics/evaluation.hpp"

#include <algorithm>
#include <stdexcept>

#include "datasets/core/params.hpp"
#include "metrics/projection.hpp"

namespace loopbench {
namespace {

std::string span_text(double first, double last) {
  return to_text(first) + " .. " + to_text(last) + " s";
}

Evaluation judge(Paired paired,
                 std::size_t possible,
                 const Trajectory& reference,
                 const Protocol& protocol) {
  Evaluation out;
  out.protocol = protocol;
  out.reference_length = path_length(reference);
  out.alignment = align(paired.reference,
                        paired.estimate,
                        protocol.align,
                        static_cast<std::size_t>(protocol.align_first));
  out.coverage.pairs = paired.reference.size();
  out.coverage.possible = possible;
  const double whole = reference.back().stamp - reference.front().stamp;
  const double judged = paired.reference.back().stamp - paired.reference.front().stamp;
  out.coverage.span = whole > 0.0 ? judged / whole : 1.0;
  out.estimate = moved(out.alignment, std::move(paired.estimate));
  out.reference = std::move(paired.reference);
  project(out.reference, protocol.project);
  project(out.estimate, protocol.project);
  return out;
}

std::string limits(const Protocol& protocol) {
  if (protocol.association == Association::interpolate) {
    return "a reference gap of at most " + to_text(protocol.max_gap) + " s";
  }
  return "at most " + to_text(protocol.max_diff) + " s apart";
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
        to_text(protocol.association) + " wants " + limits(protocol));
  }
  Evaluation out = judge(std::move(paired), estimate.size(), reference, protocol);
  if (is_of_whole_files(protocol.pairs)) out.whole = {reference, estimate};
  return out;
}

Evaluation evaluate(const Trajectory& reference,
                    const Curve& estimate,
                    const std::vector<double>& keyframe_stamps,
                    Times times,
                    const Protocol& protocol) {
  if (times == Times::keyframes) {
    return evaluate(reference, estimate.sample(keyframe_stamps), protocol);
  }
  if (reference.empty()) throw std::runtime_error("the reference has no poses");
  Paired paired;
  std::vector<double> wanted;  // the reference's stamps on the estimate's clock
  for (const StampedPose& pose : reference) {
    const double stamp = pose.stamp - protocol.offset;
    if (stamp < estimate.start() || stamp > estimate.end()) continue;
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
  Trajectory whole = is_of_whole_files(protocol.pairs) ? paired.estimate : Trajectory();
  Evaluation out = judge(std::move(paired), wanted.size(), reference, protocol);
  if (is_of_whole_files(protocol.pairs)) out.whole = {reference, std::move(whole)};
  return out;
}

}  // namespace loopbench
