#include "methods/smoothers/manifold/quasi_keyframes.hpp"

#include <algorithm>
#include <cmath>

namespace loopbench::manifold {
namespace {

// A gap of one second as stamps write it may be longer by their rounding.
constexpr double kSlack = 1e-6;  // [parts]

double parts_wanted(const StampedPose& a, const StampedPose& b, const GapRule& rule) {
  const auto parts = [](double size, std::optional<double> size_max) {
    return size_max ? std::ceil(size / *size_max - kSlack) : 1.0;
  };
  const double angle = angle_between(a.world_from_body.rotation, b.world_from_body.rotation);
  return std::max(parts(b.stamp - a.stamp, rule.time_max), parts(angle, rule.rotation_max));
}

// The nearer of the two frames around `time`, among those in begin..end (not empty).
Trajectory::const_iterator nearest(Trajectory::const_iterator begin,
                                   Trajectory::const_iterator end,
                                   double time) {
  const auto after = std::lower_bound(
      begin, end, time, [](const StampedPose& pose, double t) { return pose.stamp < t; });
  if (after == begin) return begin;
  const auto before = std::prev(after);
  return after == end || time - before->stamp <= after->stamp - time ? before : after;
}

}  // namespace

Densified with_quasi_keyframes(const Problem& problem, const GapRule& rule) {
  Densified out;
  out.nodes.reserve(problem.keyframes.size());
  const auto earlier = [](const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; };
  for (std::size_t i = 0; i < problem.keyframes.size(); ++i) {
    const StampedPose& here = problem.keyframes[i];
    out.nodes.push_back(here);
    if (i + 1 == problem.keyframes.size()) break;
    const StampedPose& next = problem.keyframes[i + 1];
    const double parts = parts_wanted(here, next, rule);
    if (parts < 2.0) continue;
    const auto& frames = problem.frames;
    auto begin = std::upper_bound(frames.begin(), frames.end(), here, earlier);
    const auto end = std::lower_bound(begin, frames.end(), next, earlier);
    if (begin == end) ++out.gaps_left;
    for (double part = 1.0; part < parts && begin != end; ++part) {
      const auto frame = nearest(begin, end, std::lerp(here.stamp, next.stamp, part / parts));
      out.nodes.push_back(*frame);
      ++out.inserted;
      begin = std::next(frame);
    }
  }
  return out;
}

}  // namespace loopbench::manifold
