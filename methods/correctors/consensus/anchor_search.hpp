/// Search for the anchors that agree, and for factors on the stated deviations.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "datasets/core/covariance.hpp"
#include "datasets/core/problem.hpp"
#include "methods/correctors/consensus/elimination.hpp"
#include "methods/correctors/consensus/factor_estimate.hpp"
#include "methods/correctors/consensus/judged_anchors.hpp"
#include "methods/correctors/consensus/unknown_motion.hpp"
#include "methods/correctors/pose_graph.hpp"

namespace loopbench::methods::consensus {

/// Replaces the anchors of `to`, a problem with the same keyframes, by those of `problem` that
/// agree, and multiplies their deviations and those of the odometry by the factors.
inline void use_agreeing_anchors(const Problem& problem,
                                 const AnchorJudgement& judgement,
                                 Problem& to) {
  to.anchors.clear();
  for (std::size_t i = 0; i < problem.anchors.size(); ++i) {
    if (!judgement.anchors[i].agrees) continue;
    to.anchors.push_back(problem.anchors[i]);
    to.anchors.back().covariance *= judgement.factor * judgement.factor;
  }
  for (Edge& edge : to.odometry) {
    if (is_unknown_motion(edge, to.planar)) continue;
    edge.information /= judgement.odometry * judgement.odometry;
  }
}

/// What the other anchors that agree predict for one, in the axes of the first keyframe.
struct PredictedAnchor {
  Eigen::VectorXd error;       ///< of the prediction, minus the measured position [m]
  Eigen::MatrixXd covariance;  ///< of the prediction
  Eigen::MatrixXd own;         ///< of the measured position, as stated
  bool is_determined = true;
};

struct AnchorExplanation {
  double log_odometry = 0.0;
  double log_anchors = 0.0;
  std::vector<bool> is_kept;
  std::vector<bool> is_excluded;  ///< from being kept, and from the score
  std::vector<PredictedAnchor> predicted;
  std::vector<double> log_odds;
  double score = -std::numeric_limits<double>::infinity();
};

class AnchorSearch {
 public:
  explicit AnchorSearch(const Problem& problem) : problem_(problem) {
    const Matrix3 axes = problem.keyframes.front().world_from_body.rotation.toRotationMatrix();
    axes_ = problem.planar ? Eigen::MatrixXd(axes.leftCols<2>()) : Eigen::MatrixXd(axes);
  }

  /// The explanation with this factor on the odometry, in which `excluded` anchors (none if it is
  /// empty) have no part; nullopt: the solver finds no solution.
  std::optional<AnchorExplanation> with_odometry(double log_odometry,
                                                 const std::vector<bool>& excluded = {}) const {
    constexpr int kPasses = 12;
    constexpr double kChange = 0.2;  // of the logarithm of the anchors' factor
    AnchorExplanation at;
    at.log_odometry = log_odometry;
    at.is_excluded = excluded;
    at.is_excluded.resize(problem_.anchors.size(), false);
    at.is_kept = at.is_excluded;
    at.is_kept.flip();
    std::optional<AnchorExplanation> best;
    Trajectory poses;  // empty: the first solution starts from a relaxation
    for (int pass = 0; pass < kPasses; ++pass) {
      if (!predict(at, poses)) return best;
      const double before = at.log_anchors;
      at.log_anchors = best_factor(at, log_uniform(poses));
      state_odds(at, log_uniform(poses));
      if (!best || at.score > best->score) best = at;
      const bool is_same = !choose(at);
      if (is_same && std::abs(at.log_anchors - before) < kChange) break;
    }
    return best;
  }

  /// The vector, given in the coordinates of errors, in the world.
  Vector3 in_world(const Eigen::VectorXd& error) const { return axes_ * error; }

 private:
  /// The problem with the anchors that are kept, under the factors.
  Problem problem_of(const AnchorExplanation& at) const {
    Problem out = problem_;
    AnchorJudgement as;
    as.factor = std::exp(at.log_anchors);
    as.odometry = std::exp(at.log_odometry);
    for (const bool is_kept : at.is_kept) as.anchors.push_back({is_kept});
    use_agreeing_anchors(problem_, as, out);
    return out;
  }

  /// Solves, and sets what the others predict for each anchor.
  bool predict(AnchorExplanation& at, Trajectory& poses) const {
    Problem problem = problem_of(at);
    PoseGraphOptimizer::Options options;
    options.covariances = true;
    options.max_iterations = 50;
    options.tolerance = 1e-6;
    options.start = PoseGraphOptimizer::Start::chordal;
    if (!poses.empty()) {
      problem.keyframes = poses;
      options.start = PoseGraphOptimizer::Start::keyframes;
    }
    Report report;
    try {
      poses = PoseGraphOptimizer(options).correct(problem, report);
    } catch (const std::runtime_error&) {
      return false;
    }
    at.predicted.clear();
    const double variance = std::exp(2.0 * at.log_anchors);
    for (std::size_t i = 0; i < problem_.anchors.size(); ++i) {
      const Anchor& anchor = problem_.anchors[i];
      const Pose& pose = poses[anchor.keyframe].world_from_body;
      const Matrix6 of_point =
          displaced(report.covariances[anchor.keyframe], pose.rotation * anchor.point_in_body);
      PredictedAnchor out;
      out.error = axes_.transpose() * anchor_error(anchor, pose);
      out.covariance = axes_.transpose() * of_point.topLeftCorner<3, 3>() * axes_;
      out.own = axes_.transpose() * anchor.covariance * axes_;
      if (at.is_kept[i]) leave_out(variance, out);
      at.predicted.push_back(std::move(out));
    }
    return true;
  }

  /// Takes an anchor out of the solution that it took part in: with its covariance C and that of
  /// the solution S, the residual has the covariance C - S, and without the anchor the error is
  /// C (C - S)^-1 e, with the covariance C (C - S)^-1 C.
  static void leave_out(double variance, PredictedAnchor& of) {
    constexpr double kDetermined = 1e-7;  // least share of the variance that is not rounding
    const Eigen::MatrixXd own = variance * of.own;
    const Eigen::LLT<Eigen::MatrixXd> root(own);
    const Eigen::MatrixXd lower = root.matrixL();
    const Eigen::MatrixXd half = root.matrixL().solve(of.covariance);
    const Eigen::MatrixXd white = root.matrixL().solve(half.transpose());
    const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(own.rows(), own.cols()) - white;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(left);
    of.is_determined = axes.eigenvalues().minCoeff() > kDetermined;
    if (!of.is_determined) return;
    const Eigen::MatrixXd wider = left.inverse();
    const Eigen::VectorXd error = root.matrixL().solve(of.error);
    of.error = lower * (wider * error);
    of.covariance = lower * wider * lower.transpose() - own;
  }

  /// Log density of an outlier: uniform over the box of the positions in the axes of the first
  /// keyframe; each side is at least a tenth of the longest, and a deviation of an anchor.
  double log_uniform(const Trajectory& poses) const {
    Eigen::VectorXd low = axes_.transpose() * poses.front().world_from_body.translation;
    Eigen::VectorXd high = low;
    for (const StampedPose& each : poses) {
      const Eigen::VectorXd at = axes_.transpose() * each.world_from_body.translation;
      low = low.cwiseMin(at);
      high = high.cwiseMax(at);
    }
    double least = 0.0;
    for (const Anchor& each : problem_.anchors) {
      least = std::max(least, std::sqrt(each.covariance.diagonal().maxCoeff()));
    }
    const Eigen::VectorXd size = high - low;
    double out = 0.0;
    for (const double side : size) out -= std::log(std::max({side, 0.1 * size.maxCoeff(), least}));
    return out;
  }

  static double log_odds_of(const PredictedAnchor& of, double log_anchors, double uniform) {
    if (!of.is_determined) return 0.0;
    const Eigen::MatrixXd covariance = of.covariance + std::exp(2.0 * log_anchors) * of.own;
    return normal_density(of.error, covariance).log_density - uniform;
  }

  /// Sum over all anchors as the likelier of true and outlier, and the prior of the factors.
  static double score(const AnchorExplanation& at, double log_anchors, double uniform) {
    double out = log_prior({at.log_odometry, at.log_odometry, log_anchors});
    for (std::size_t i = 0; i < at.predicted.size(); ++i) {
      if (at.is_excluded[i]) continue;
      out += std::max(0.0, log_odds_of(at.predicted[i], log_anchors, uniform));
    }
    return out;
  }

  /// The anchors' factor of the highest score: from 1/16 to 256, in quarter octaves.
  static double best_factor(const AnchorExplanation& at, double uniform) {
    double out = 0.0, most = -std::numeric_limits<double>::infinity();
    for (int quarters = -16; quarters <= 32; ++quarters) {
      const double trial = 0.25 * quarters * std::log(2.0);
      const double value = score(at, trial, uniform);
      if (!(value > most)) continue;
      most = value;
      out = trial;
    }
    return out;
  }

  static void state_odds(AnchorExplanation& at, double uniform) {
    at.score = score(at, at.log_anchors, uniform);
    at.log_odds.clear();
    for (const PredictedAnchor& each : at.predicted) {
      at.log_odds.push_back(log_odds_of(each, at.log_anchors, uniform));
    }
  }

  /// Drops those of the kept whose log odds are at least half of the worst, or, if none is likelier
  /// an outlier, takes those back that are likelier true. False: nothing changes.
  static bool choose(AnchorExplanation& at) {
    double worst = 0.0;
    for (std::size_t i = 0; i < at.is_kept.size(); ++i) {
      if (at.is_kept[i]) worst = std::min(worst, at.log_odds[i]);
    }
    bool is_changed = false;
    for (std::size_t i = 0; i < at.is_kept.size(); ++i) {
      const bool is_dropped = worst < 0.0 && at.is_kept[i] && at.log_odds[i] <= 0.5 * worst;
      const bool is_taken =
          worst == 0.0 && !at.is_kept[i] && !at.is_excluded[i] && at.log_odds[i] > 0.0;
      if (!is_dropped && !is_taken) continue;
      at.is_kept[i] = is_taken;
      is_changed = true;
    }
    return is_changed;
  }

  const Problem& problem_;
  Eigen::MatrixXd axes_;  ///< of the plane, or of space, as columns
};

/// The best explanation over the factors on the odometry: every second octave, then those beside.
inline std::optional<AnchorExplanation> best_explanation(const AnchorSearch& search,
                                                         bool is_calibrated) {
  std::optional<AnchorExplanation> best;
  const auto attempt = [&](double octaves) {
    std::optional<AnchorExplanation> found = search.with_odometry(octaves * std::log(2.0));
    if (found && (!best || found->score > best->score)) best = std::move(found);
  };
  attempt(0.0);
  if (is_calibrated) return best;
  for (const double octaves : {-4.0, -2.0, 2.0, 4.0, 6.0, 8.0}) attempt(octaves);
  if (!best) return best;
  const double middle = std::round(best->log_odometry / std::log(2.0));
  for (const double beside : {-1.0, 1.0}) attempt(middle + beside);
  return best;
}

}  // namespace loopbench::methods::consensus
