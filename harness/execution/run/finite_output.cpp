#include "harness/execution/run/finite_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace loopbench::harness {
namespace {

void require_finite_at(const Curve& curve, const std::vector<double>& times, const char* what) {
  const Trajectory poses = curve.sample(times);
  const auto is_bad = [](const StampedPose& pose) { return !is_finite(pose.world_from_body); };
  const auto first = std::ranges::find_if(poses, is_bad);
  if (first == poses.end()) return;
  throw std::runtime_error(fmt::format("the estimate is not finite at {} of {} {}, first at {} s",
                                       std::ranges::count_if(poses, is_bad),
                                       poses.size(),
                                       what,
                                       to_text(first->stamp)));
}

}  // namespace

void require_finite(const Curve& curve, const Sequence& sequence, const Sweep& sweep) {
  require_finite_at(curve, stamps(sequence.problem.keyframes), "keyframes");
  if (sequence.reference.empty() || std::ranges::count(sweep.times, metrics::Times::dense) == 0)
    return;
  std::set<double> offsets;
  for (const metrics::NamedProtocol& protocol : sweep.protocols)
    offsets.insert(protocol.rules.offset);
  for (const double offset : offsets) {
    std::vector<double> times;
    for (const StampedPose& pose : sequence.reference) {
      const double time = pose.stamp - offset;
      if (time >= curve.start() && time <= curve.end()) times.push_back(time);
    }
    require_finite_at(curve, times, "reference stamps");
  }
}

void require_finite_sections(methods::Report& report) {
  const auto is_bad = [](const methods::Section& section) {
    return !std::isfinite(section.begin) || !std::isfinite(section.end);
  };
  const auto first = std::ranges::find_if(report.sections, is_bad);
  if (first == report.sections.end()) return;
  const std::string why =
      fmt::format("section {} ('{}') is from {} to {} s, expected finite stamps",
                  first - report.sections.begin() + 1,
                  first->kind,
                  to_text(first->begin),
                  to_text(first->end));
  report.sections.clear();
  throw std::runtime_error(why);
}

}  // namespace loopbench::harness
