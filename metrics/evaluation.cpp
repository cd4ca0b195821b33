#include "metrics/evaluation.hpp"

#include <algorithm>
#include <stdexcept>

#include "datasets/core/params.hpp"
#include "metrics/losses.hpp"
#include "metrics/median.hpp"
#include "metrics/position_only.hpp"
#include "metrics/projection.hpp"

namespace loopbench {
namespace {

std::string span_text(double first, double last) {
  return to_text(first) + " .. " + to_text(last) + " s";
}

/// Pauses of the pairs that are no rhythm of theirs, while the reference went on [s].
double time_lost(const Trajectory& reference, const Trajectory& pairs) {
  constexpr double kPause = 2.0;      // [s], that of DiagnosticsOptions
  constexpr double kStanding = 0.05;  // [m/s], likewise
  constexpr double kRhythms = 10.0;   // keyframes may lie seconds apart all along
  double sum = 0.0;
  std::vector<Loss> lost = losses(reference, pairs, 0.0, kPause, kStanding);
  if (lost.empty()) return sum;
  std::vector<double> steps;
  steps.reserve(pairs.size());
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    steps.push_back(pairs[i].stamp - pairs[i - 1].stamp);
  }
  const double longest = kRhythms * median(steps);
  for (const Loss& loss : lost) {
    if (loss.end - loss.begin > longest) sum += loss.end - loss.begin;
  }
  return sum;
}

void require_attitudes(const Paired& paired, Align align) {
  if (align != Align::origin && align != Align::posyaw_origin) return;
  const bool is_reference = is_position_only(paired.reference);
  if (is_reference == is_position_only(paired.estimate)) return;
  throw std::runtime_error(
      "alignment " + to_text(align) + ": the " + (is_reference ? "reference" : "estimate") +
      " keeps one attitude while its path turns: it holds positions only, so its first pose aligns "
      "nothing; align by se3, sim3 or none");
}

Evaluation judge(Paired paired,
                 std::size_t possible,
                 const Trajectory& reference,
                 const Protocol& protocol) {
  require_attitudes(paired, protocol.align);
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
  const double judged = paired.reference.back().stamp - paired.reference.front().stamp -
                        time_lost(reference, paired.reference);
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

std::string why_no_attitude(const Evaluation& evaluation) {
  const auto text = [](const std::string& whose) {
    return "the " + whose +
           " keeps one attitude while its path turns: it holds positions only, so rotation is not "
           "judged";
  };
  if (is_position_only(evaluation.reference)) return text("reference");
  if (is_position_only(evaluation.estimate)) return text("estimate");
  return "";
}

}  // namespace loopbench
