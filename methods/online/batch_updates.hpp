/// Any method as an incremental one: it solves the complete problem again at each update.
#pragma once

#include <memory>
#include <optional>

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

}  // namespace loopbench::methods
