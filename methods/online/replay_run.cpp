#include "methods/online/replay_run.hpp"

#include <algorithm>
#include <chrono>

#include "datasets/core/pose_rule.hpp"

namespace loopbench::methods {
namespace {

/// Adds the phases of an update to those of the same name, and replaces everything else.
void merge(Report& all, Report of_update) {
  for (Phase& phase : of_update.phases) {
    const auto known = std::ranges::find(all.phases, phase.name, &Phase::name);
    if (known == all.phases.end()) {
      all.phases.push_back(std::move(phase));
    } else {
      known->seconds += phase.seconds;
    }
  }
  all.counts = std::move(of_update.counts);
  all.notes = std::move(of_update.notes);
  all.sections = std::move(of_update.sections);
}

}  // namespace

void ReplayRun::add_keyframe(std::size_t i) {
  const double now = problem_.keyframes[i].stamp;
  waiting_.keyframes.push_back(problem_.keyframes[i]);
  const bool is_last = i + 1 == problem_.keyframes.size();
  while (edges_ < problem_.odometry.size() && problem_.odometry[edges_].to <= i) {
    waiting_.odometry.push_back(problem_.odometry[edges_++]);
  }
  while (frames_ < problem_.frames.size() && (is_last || problem_.frames[frames_].stamp <= now)) {
    waiting_.frames.push_back(problem_.frames[frames_++]);
  }
  if (i > 0 && !problem_.shared_landmarks.empty()) {
    waiting_.shared_landmarks.push_back(problem_.shared_landmarks[i - 1]);
  }
  chain_.extend(i + 1);
}

void ReplayRun::add(const Arrival& arrival) {
  (arrival.is_withdrawn ? waiting_.withdrawn : waiting_.closures).push_back(arrival.closure);
}

void ReplayRun::update(double time) {
  using Clock = std::chrono::steady_clock;
  Report report;
  const auto begin = Clock::now();
  Trajectory solved = method_.update(waiting_, report);
  const std::chrono::duration<double> took = Clock::now() - begin;
  const Trajectory& before = chain_.poses();
  if (stamps(solved) != stamps(before)) {
    throw std::runtime_error("an update at " + to_text(time) +
                             " s did not return one pose per keyframe");
  }
  require_valid(solved, "updated keyframe");
  replay_.updates.push_back({time,
                             solved.size(),
                             waiting_.closures.size() + waiting_.withdrawn.size(),
                             took.count(),
                             before.back().world_from_body,
                             solved.back().world_from_body});
  chain_.replace(std::move(solved));
  merge(report_, std::move(report));
  waiting_ = {};
}

void ReplayRun::run(std::span<const Arrival> arrivals) {
  double time = 0.0;  // of the last arrival or keyframe
  const auto add_until = [&](double now) {
    while (!arrivals.empty() && arrivals.front().time <= now) {
      add(arrivals.front());
      arrivals = arrivals.subspan(1);
    }
  };
  const auto changes = [&] { return waiting_.closures.size() + waiting_.withdrawn.size(); };
  for (std::size_t i = 0; i < problem_.keyframes.size(); ++i) {
    add_keyframe(i);
    time = problem_.keyframes[i].stamp;
    add_until(time);
    if (changes() >= every_) update(time);
    replay_.causal.push_back(chain_.poses().back());
  }
  if (!arrivals.empty()) time = arrivals.back().time;
  add_until(time);
  if (changes() > 0 || !waiting_.keyframes.empty()) update(time);
}

}  // namespace loopbench::methods
