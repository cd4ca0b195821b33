#include "methods/online/batch_updates.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace loopbench::methods {
namespace {

template <class T>
void append(std::vector<T>& to, const std::vector<T>& added) {
  to.insert(to.end(), added.begin(), added.end());
}

auto order_of(const Edge& edge) { return std::tie(edge.to, edge.from); }

}  // namespace

BatchUpdates::BatchUpdates(const Estimator& method, bool planar, bool warm)
    : method_(method), is_warm_(warm), chain_(known_) {
  known_.planar = planar;
}

Trajectory BatchUpdates::update(const Increment& added, Report& report) {
  append(known_.keyframes, added.keyframes);
  append(known_.odometry, added.odometry);
  append(known_.shared_landmarks, added.shared_landmarks);
  if (!is_warm_) append(known_.frames, added.frames);
  std::vector<Edge>& closures = known_.closures;
  for (const Edge& closure : added.closures) {
    closures.insert(std::ranges::upper_bound(closures, order_of(closure), {}, order_of), closure);
  }
  for (const Edge& closure : added.withdrawn) {
    const auto is_it = [&](const Edge& other) { return is_same_measurement(closure, other); };
    const auto found = std::ranges::find_if(closures, is_it);
    if (found != closures.end()) closures.erase(found);
  }
  chain_.extend(known_.keyframes.size());
  curve_.reset();
  Trajectory tracked;
  if (is_warm_) tracked = std::exchange(known_.keyframes, chain_.poses());
  if (!solve(report) && !added.withdrawn.empty()) chain_.restart();
  if (is_warm_) known_.keyframes = std::move(tracked);
  return chain_.poses();
}

bool BatchUpdates::solve(Report& report) {
  declined_by_.reset();
  if (!method_.why_declined(known_).empty()) {
    ++declined_;
    return false;
  }
  try {
    curve_ = method_.estimate(known_, report);
  } catch (const Declined& reason) {  // a program answers only while it runs
    declined_by_ = reason;
    ++declined_;
    return false;
  }
  report.covariances.clear();  // of the keyframes known now
  chain_.replace(curve_->sample(stamps(known_.keyframes)));
  return true;
}

}  // namespace loopbench::methods
