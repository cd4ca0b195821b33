#include "methods/correctors/closure_ledger.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "datasets/core/upper_median.hpp"
#include "methods/correctors/chain.hpp"
#include "methods/correctors/closure_places.hpp"
#include "methods/correctors/looped_chain.hpp"

namespace loopbench::methods {
namespace {

constexpr std::int64_t kMaxClosures = 1000;  // the inverse of the loop equations has 6,000 rows

constexpr std::size_t kMinPlaces = 3;    // two places cannot show which of them is wrong
constexpr double kMinCovered = 0.3;      // below it, most of the path is checked by no prediction
constexpr double kContradiction = 10.0;  // chi2 per degree of freedom of one closure
constexpr double kTooSmall = 3.0;        // median chi2: the covariances rather than closures
constexpr double kHelps = 0.9;           // ratio; none of 64 such chains got worse

using Index = Eigen::Index;

ClosureError closure_error(const Twist& residual, const Matrix6& covariance, bool planar) {
  constexpr double kDegrees = 180.0 / 3.14159265358979323846;
  const double chi2 = residual.dot(covariance.llt().solve(residual));
  return {residual.head<3>().norm(), kDegrees * residual.tail<3>().norm(), chi2 / (planar ? 3 : 6)};
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

/// The joint solution with the inverse of its equations.
struct JointSolution {
  LoopedChain chain;
  LoopJacobian jacobian;
  Eigen::MatrixXd inverse;  ///< M^-1
  Eigen::VectorXd lambda;

  JointSolution(const Problem& problem, const NoiseModel& noise) : chain(solved(problem, noise)) {
    LoopEquations equations = chain.equations();
    const Index size = equations.jacobian.gap.size();
    lambda = equations.factor.solve(equations.jacobian.gap);
    inverse = equations.factor.solve(Eigen::MatrixXd::Identity(size, size));
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
    const Eigen::MatrixXd block = joint.inverse(rows, rows);
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

/// Effect of each closure alone: on the cost and on the positions of the keyframes.
void add_influence(const Problem& problem,
                   const NoiseModel& noise,
                   const JointSolution& joint,
                   ClosureLedger& ledger) {
  const std::vector<Pose>& poses = joint.chain.centred_poses();
  for (std::size_t k = 0; k < ledger.rows.size(); ++k) {
    LedgerRow& row = ledger.rows[k];
    const auto at = static_cast<Index>(6 * k);
    const Matrix6 covariance = joint.inverse.block<6, 6>(at, at).inverse();
    const Twist residual = covariance * of_closure(joint.lambda, k);
    row.cost_drop = residual.dot(of_closure(joint.lambda, k));
    const Eigen::VectorXd change = -joint.inverse.middleCols<6>(at) * residual;
    const std::vector<Twist> pull = constraint_force_increments(
        joint.jacobian.loop, problem.odometry.size(), problem.closures, change);
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

/// Errors of the places in metres: root mean square over their closures.
void add_ratio(const std::vector<std::vector<std::size_t>>& places, ClosureLedger& ledger) {
  double sum = 0.0;
  for (const std::vector<std::size_t>& place : places) {
    double predicted = 0.0, raw = 0.0;
    for (const std::size_t k : place) {
      predicted += std::pow(ledger.rows[k].predicted->metres, 2);
      raw += std::pow(ledger.rows[k].in_odometry.metres, 2);
    }
    constexpr double kExact = 1e-18;  // squared error that is rounding [m^2]
    sum += 0.5 * std::log(std::max(predicted, kExact) / std::max(raw, kExact));
    if (predicted < raw) ++ledger.better_places;
  }
  ledger.ratio = std::exp(sum / static_cast<double>(places.size()));
}

LedgerVerdict verdict_of(const ClosureLedger& ledger) {
  if (ledger.rows.size() > 1 && ledger.largest_chi2 > kContradiction) {
    return ledger.odometry_chi2 > kTooSmall ? LedgerVerdict::covariances
                                            : LedgerVerdict::contradiction;
  }
  if (ledger.places < kMinPlaces) return LedgerVerdict::few_places;
  if (ledger.covered < kMinCovered) return LedgerVerdict::little_covered;
  return ledger.ratio < kHelps ? LedgerVerdict::helps : LedgerVerdict::not_shown;
}

/// The ledger without its ranking.
ClosureLedger unranked_ledger(const Problem& problem) {
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
  add_influence(problem, noise, joint, out);
  if (out.places >= 2) add_ratio(places, out);
  const double dof = problem.planar ? 3.0 : 6.0;
  std::vector<double> odometry_chi2;
  for (const LedgerRow& row : out.rows) {
    odometry_chi2.push_back(row.in_odometry.chi2);
    const double by_places = row.predicted ? row.predicted->chi2 : 0.0;
    out.largest_chi2 = std::max({out.largest_chi2, by_places, row.cost_drop / dof});
  }
  out.odometry_chi2 = upper_median(odometry_chi2);
  out.verdict = verdict_of(out);
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
  Problem rest = problem;
  rest.closures.erase(rest.closures.begin() + static_cast<std::ptrdiff_t>(order.front()));
  if (is_contradicted(unranked_ledger(rest).verdict)) {
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
  ClosureLedger out = unranked_ledger(problem);
  rank_suspects(problem, out);
  return out;
}

}  // namespace loopbench::methods
