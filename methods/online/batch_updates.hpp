/// Any method as an incremental one: it solves the complete problem again at each update.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "datasets/core/error.hpp"
#include "methods/method.hpp"
#include "methods/online/extended_chain.hpp"

namespace loopbench::methods {

/// The cost of an update is that of the method on all data so far.
class BatchUpdates final : public Incremental {
 public:
  /// `method` must outlive this object. `warm`: the method gets the last solution, extended by
  /// odometry, as keyframes, and no frames; otherwise the keyframes of the tracker.
  BatchUpdates(const Estimator& method, bool planar, bool warm);
  BatchUpdates(const BatchUpdates&) = delete;  // chain_ refers to known_
  BatchUpdates& operator=(const BatchUpdates&) = delete;

  /// Returns the poses of the method's curve at the keyframes. Where the method declines the data
  /// so far, by why_declined() or by throwing Declined, these are the last solution extended by
  /// odometry, or odometry alone if that solution has a closure that is withdrawn now.
  Trajectory update(const Increment& added, Report& report) override;

  /// Number of updates that the method declined.
  int declined() const { return declined_; }

  /// The exception by which the method declined the last update; nullopt if it threw none.
  const std::optional<Declined>& declined_by() const { return declined_by_; }

  /// The curve of the last update; null if the method declined it.
  std::unique_ptr<const Curve> take_curve() { return std::move(curve_); }

 private:
  bool solve(Report& report);  ///< false if the method declines

  const Estimator& method_;
  bool is_warm_;
  Problem known_;
  ExtendedChain chain_;
  std::unique_ptr<const Curve> curve_;
  std::optional<Declined> declined_by_;
  int declined_ = 0;
};

template <class T>
inline void append(std::vector<T>& to, const std::vector<T>& added) {
  to.insert(to.end(), added.begin(), added.end());
}

inline auto order_of(const Edge& edge) { return std::tie(edge.to, edge.from); }

inline BatchUpdates::BatchUpdates(const Estimator& method, bool planar, bool warm)
    : method_(method), is_warm_(warm), chain_(known_) {
  known_.planar = planar;
}

inline Trajectory BatchUpdates::update(const Increment& added, Report& report) {
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

inline bool BatchUpdates::solve(Report& report) {
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
