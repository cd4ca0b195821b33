#include "methods/correctors/closure_ledger.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "datasets/core/closure_places.hpp"
#include "datasets/core/factorisations.hpp"
#include "datasets/core/upper_median.hpp"
#include "methods/correctors/chain.hpp"
#include "methods/correctors/looped_chain.hpp"

namespace loopbench::methods {
namespace {

constexpr std::int64_t kMaxClosures = 1000;  // the inverse of the loop equations has 6,000 rows

constexpr double kMinCovered = 0.3;      // below it, most of the path is checked by no prediction
constexpr double kContradiction = 10.0;  // chi2 per degree of freedom of one closure
constexpr double kTooSmall = 3.0;        // median chi2: the covariances rather than closures
constexpr double kHelps = 0.9;           // ratio; none of 64 such chains got worse

using Index = Eigen::Index;

ClosureError closure_error(const Twist& residual, const Matrix6& covariance, bool planar) {
  constexpr double kDegrees = 180.0 / 3.14159265358979323846;
  const double chi2 = residual.dot(covariance.llt().solve(residual));
  // The rotation by a linear residual can exceed half a turn.
  const double degrees = std::abs(std::remainder(kDegrees * residual.tail<3>().norm(), 360.0));
  return {residual.head<3>().norm(), degrees, chi2 / (planar ? 3 : 6)};
}

/// The rows and columns of some closures in a vector or matrix over all.
std::vector<Index> rows_of(const std::vector<std::size_t>& closures) {
  std::vector<Index> out;
  for (const std::size_t k : closures) {
    for (Index i = 0; i < 6; ++i) out.push_back(static_cast<Index>(6 * k) + i);
  }
  return out;
}

/// Closures against the odometry alone.
void add_odometry_errors(const Problem& problem, const NoiseModel& noise, ClosureLedger& ledger) {
  LoopedChain open(problem, noise);
  open.set_errors(std::vector<Twist>(problem.odometry.size(), Twist::Zero()));
  const LoopJacobian jacobian = open.linearise();
  const LoopSums& sums = open.sums();
  const std::vector<Matrix6> running = running_sum(sums, [&](std::size_t i) -> Matrix6 {
    return jacobian.edge[i] * noise.covariance[i] * jacobian.edge[i].transpose();
  });
  for (std::size_t k = 0; k < problem.closures.size(); ++k) {
    const Matrix6 covariance =
        jacobian.loop[k] * sums.over(running, k) * jacobian.loop[k].transpose() +
        noise.closure_covariance[k];
    ledger.rows[k].in_odometry =
        closure_error(of_closure(jacobian.gap, k), covariance, problem.planar);
  }
}

/// L^-1 of a lower triangular L, in panels of which only the rows from the diagonal on are
/// computed.
Eigen::MatrixXd inverse_of_lower(const Eigen::MatrixXd& lower) {
  constexpr Index kPanel = 96;  // columns
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(lower.rows(), lower.cols());
  for (Index begin = 0; begin < lower.rows(); begin += kPanel) {
    const Index rows = lower.rows() - begin;
    auto panel = out.block(begin, begin, rows, std::min(kPanel, rows));
    panel.diagonal().setOnes();
    lower.bottomRightCorner(rows, rows).triangularView<Eigen::Lower>().solveInPlace(panel);
  }
  return out;
}

/// The joint solution with the inverse of the factor of its equations.
struct JointSolution {
  LoopedChain chain;
  LoopJacobian jacobian;
  Eigen::MatrixXd half;  ///< L^-1 of M = L L', so M^-1 = half' half
  Eigen::VectorXd lambda;

  JointSolution(const Problem& problem, const NoiseModel& noise) : chain(solved(problem, noise)) {
    LoopEquations equations = chain.equations();
    lambda = equations.factor.solve(equations.jacobian.gap);
    half = inverse_of_lower(equations.factor.matrixLLT());
    jacobian = std::move(equations.jacobian);
  }

  static LoopedChain solved(const Problem& problem, const NoiseModel& noise) {
    Report unused;
    return lowest_minimum(problem, noise, {}, unused);
  }
};

/// Errors of the closures of each place against the solution without that place.
void add_predictions(const JointSolution& joint,
                     const std::vector<std::vector<std::size_t>>& places,
                     bool planar,
                     ClosureLedger& ledger) {
  if (places.size() < 2) return;
  for (const std::vector<std::size_t>& place : places) {
    const std::vector<Index> rows = rows_of(place);
    const Eigen::MatrixXd columns = joint.half(Eigen::all, rows);
    const Eigen::MatrixXd block = columns.transpose() * columns;
    const Eigen::MatrixXd covariance =
        block.llt().solve(Eigen::MatrixXd::Identity(block.rows(), block.cols()));
    const Eigen::VectorXd residual = covariance * joint.lambda(rows);
    for (std::size_t i = 0; i < place.size(); ++i) {
      const auto at = static_cast<Index>(6 * i);
      ledger.rows[place[i]].predicted =
          closure_error(of_closure(residual, i), covariance.block<6, 6>(at, at), planar);
    }
  }
}

/// Effect of each closure alone on the cost. Returns the change of all multipliers without each
/// closure, one column per closure.
Eigen::MatrixXd add_cost_drops(const JointSolution& joint, ClosureLedger& ledger) {
  Eigen::MatrixXd changes(joint.half.rows(), static_cast<Index>(ledger.rows.size()));
  for (std::size_t k = 0; k < ledger.rows.size(); ++k) {
    const auto columns = joint.half.middleCols<6>(static_cast<Index>(6 * k));
    const Matrix6 covariance = inverse_of(columns.transpose() * columns);
    const Twist residual = covariance * of_closure(joint.lambda, k);
    ledger.rows[k].cost_drop = residual.dot(of_closure(joint.lambda, k));
    changes.col(static_cast<Index>(k)) = -columns * residual;
  }
  return joint.half.triangularView<Eigen::Lower>().transpose() * changes;
}

/// Effect of each closure alone on the positions of the keyframes.
void add_moves(const Problem& problem,
               const NoiseModel& noise,
               const JointSolution& joint,
               const Eigen::MatrixXd& changes,
               ClosureLedger& ledger) {
  const std::vector<Pose>& poses = joint.chain.centred_poses();
  for (std::size_t k = 0; k < ledger.rows.size(); ++k) {
    LedgerRow& row = ledger.rows[k];
    const std::vector<Twist> pull = constraint_force_increments(joint.jacobian.loop,
                                                                problem.odometry.size(),
                                                                problem.closures,
                                                                changes.col(static_cast<Index>(k)));
    Twist force = Twist::Zero(), moved = Twist::Zero();
    double sum = 0.0;
    for (std::size_t i = 0; i < problem.odometry.size(); ++i) {
      const Matrix6& edge = joint.jacobian.edge[i];
      force += pull[i];
      moved -= edge * (noise.covariance[i] * (edge.transpose() * force));
      const Vector3 shift = moved.head<3>() + moved.tail<3>().cross(poses[i + 1].translation);
      sum += shift.squaredNorm();
      if (shift.norm() > row.moves_max) row.moves_max = shift.norm(), row.moves_at = i + 1;
    }
    row.moves_rms = std::sqrt(sum / static_cast<double>(poses.size()));
  }
}

/// `largest_chi2`: per degree of freedom, of a closure to the solution without it or its place.
LedgerVerdict verdict_of(const ClosureLedger& ledger, double largest_chi2) {
  if (ledger.rows.size() > 1 && largest_chi2 > kContradiction) {
    return ledger.odometry_chi2 > kTooSmall ? LedgerVerdict::covariances
                                            : LedgerVerdict::contradiction;
  }
  if (ledger.places < kMinPlaces) return LedgerVerdict::few_places;
  if (ledger.covered < kMinCovered) return LedgerVerdict::little_covered;
  const bool is_majority = ledger.places > kMinPlaces || ledger.better_places == kMinPlaces;
  return ledger.ratio < kHelps && is_majority ? LedgerVerdict::helps : LedgerVerdict::not_shown;
}

/// The ledger without its ranking; the verdict needs no `moves`.
ClosureLedger unranked_ledger(const Problem& problem, bool with_moves) {
  const NoiseModel noise = stated_noise_model(problem);
  const std::vector<std::vector<std::size_t>> places = closure_places(problem.closures);
  ClosureLedger out;
  out.rows.resize(problem.closures.size());
  out.places = places.size();
  out.covered = covered_share(problem, places);
  std::vector<double> travelled(problem.keyframes.size(), 0.0);
  for (std::size_t i = 0; i < problem.odometry.size(); ++i) {
    travelled[i + 1] = travelled[i] + problem.odometry[i].from_from_to.translation.norm();
  }
  for (std::size_t p = 0; p < places.size(); ++p) {
    for (const std::size_t k : places[p]) out.rows[k].place = p;
  }
  for (std::size_t k = 0; k < out.rows.size(); ++k) {
    const Edge& loop = problem.closures[k];
    out.rows[k].loop_length = travelled[loop.to] - travelled[loop.from];
  }
  add_odometry_errors(problem, noise, out);
  const JointSolution joint(problem, noise);
  add_predictions(joint, places, problem.planar, out);
  const Eigen::MatrixXd changes = add_cost_drops(joint, out);
  if (with_moves) add_moves(problem, noise, joint, changes, out);
  if (out.places >= 2) {
    const auto [ratio, better] = place_prediction(
        places,
        [&](std::size_t k) { return out.rows[k].predicted->metres; },
        [&](std::size_t k) { return out.rows[k].in_odometry.metres; });
    out.ratio = ratio;
    out.better_places = better;
  }
  const double dof = problem.planar ? 3.0 : 6.0;
  double largest_chi2 = 0.0;
  std::vector<double> odometry_chi2;
  for (const LedgerRow& row : out.rows) {
    odometry_chi2.push_back(row.in_odometry.chi2);
    const double by_places = row.predicted ? row.predicted->chi2 : 0.0;
    largest_chi2 = std::max({largest_chi2, by_places, row.cost_drop / dof});
  }
  out.odometry_chi2 = upper_median(odometry_chi2);
  out.verdict = verdict_of(out, largest_chi2);
  return out;
}

/// Orders all closures, the most suspicious first. A single false closure has the largest decrease
/// of the cost. Several false closures mask each other there, but not against the odometry.
void rank_suspects(const Problem& problem, ClosureLedger& ledger) {
  std::vector<std::size_t>& order = ledger.suspects;
  order.resize(ledger.rows.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto sort_by = [&](auto value) {
    std::ranges::stable_sort(
        order, std::greater{}, [&](std::size_t k) { return value(ledger.rows[k]); });
  };
  sort_by([](const LedgerRow& row) { return row.cost_drop; });
  if (!is_contradicted(ledger.verdict) || ledger.rows.size() < 2) return;
  const Problem rest = without_closures(problem, {order.front()});
  if (is_contradicted(unranked_ledger(rest, false).verdict)) {
    sort_by([](const LedgerRow& row) { return row.in_odometry.chi2; });
  }
}

}  // namespace

std::string why_no_ledger(const Problem& problem) {
  if (!problem.anchors.empty()) return "the problem has anchors, which the ledger does not use";
  if (has_scale_drift(problem)) return "edges change the scale, which the ledger does not estimate";
  return loops_fault(problem, kMaxClosures, "the limit of the ledger");
}

ClosureLedger closure_ledger(const Problem& problem) {
  ClosureLedger out = unranked_ledger(problem, true);
  rank_suspects(problem, out);
  return out;
}

}  // namespace loopbench::methods
