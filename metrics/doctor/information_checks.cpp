#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/graph_checks.hpp"
#include "metrics/doctor/loop_likelihood.hpp"

namespace loopbench::metrics {
namespace {

void exchange_blocks(std::vector<Edge>& edges) {
  for (Edge& edge : edges) {
    const Matrix6 given = edge.information;
    edge.information.topLeftCorner<3, 3>() = given.bottomRightCorner<3, 3>();
    edge.information.bottomRightCorner<3, 3>() = given.topLeftCorner<3, 3>();
  }
}

/// The loops of a problem in groups, and the noise that fits each; loops alone if there are few, so
/// that a false one among them is outvoted.
struct GroupFits {
  explicit GroupFits(const Problem& problem)
      : chain(chain_of(problem)),
        groups(loop_groups(problem.closures, chain, problem.closures.size() < 6 ? 1 : 5)) {
    for (const LoopGroup& group : groups) fits.push_back(group.fit(group.as_read()));
  }

  /// Median factor of the variances [-].
  double factor(std::size_t kind) const {
    std::vector<double> logarithms;
    for (const LoopFit& fit : fits) logarithms.push_back(fit.factors[kind]);
    return std::exp(median_value(std::move(logarithms)));
  }

  /// Mean over the groups of a log likelihood.
  template <class Of>
  double mean(Of of) const {
    double out = 0.0;
    for (std::size_t i = 0; i < groups.size(); ++i)
      out += of(i) / static_cast<double>(groups.size());
    return out;
  }

  Chain chain;
  std::vector<LoopGroup> groups;
  std::vector<LoopFit> fits;
};

/// Edges whose variances are wrong.
struct WrongScale {
  const char* edges;
  const char* options;
  double factor;
};

std::optional<WrongScale> wrong_scale(const GroupFits& loops) {
  constexpr double kTooSmall = 100.0, kTooLarge = 1e-5;  // fitted over stated variance
  constexpr double kExact = 1e-8;  // smaller ones are those of closures without noise
  constexpr double kSmallLoss = 15.0;
  const double odometry = loops.factor(0), closures = loops.factor(1);
  if (odometry < kTooLarge || odometry > kTooSmall) {
    const double loss = loops.mean([&](std::size_t i) {
      const double f = std::log(odometry);
      return loops.groups[i].log_likelihood({f, 0.0}) - loops.groups[i].log_likelihood({f, f});
    });
    if (loss > kSmallLoss) return WrongScale{"the odometry", "odometry.sigma_*", odometry};
    return WrongScale{"all edges", "odometry.sigma_*, closures.sigma_*", odometry};
  }
  if (closures > kTooSmall || (closures < kTooLarge && closures > kExact)) {
    return WrongScale{"the closures", "closures.sigma_*", closures};
  }
  return std::nullopt;
}

}  // namespace

std::optional<InputFinding> check_information(const Problem& problem) {
  constexpr std::size_t kFewest = 2;
  constexpr double kLeastOfOrder = 8.0;
  constexpr double kExactGap = 1e-4;  // [m]; of measurements without noise
  if (problem.closures.size() < kFewest) return std::nullopt;
  const GroupFits as_read(problem);
  std::vector<double> gaps;
  for (const Edge& closure : problem.closures) gaps.push_back(gap_of(closure, as_read.chain));
  if (median_value(std::move(gaps)) < kExactGap) return std::nullopt;
  Problem other = problem;
  exchange_blocks(other.odometry);
  exchange_blocks(other.closures);
  const GroupFits exchanged(other);
  const double gain = as_read.mean([&](std::size_t i) {
    return exchanged.fits[i].log_likelihood - as_read.fits[i].log_likelihood;
  });
  if (gain > kLeastOfOrder) {
    return InputFinding{
        Fault::information_order,
        fmt::format("exchanging the blocks of translation and rotation: mean logarithm of the "
                    "ratio of likelihoods of {} groups of loops {:.1f}",
                    as_read.groups.size(),
                    gain),
        "check the order of the blocks: g2o has those of x y z first",
        1.0 - std::exp(-0.25 * gain),
        gain};
  }
  const auto wrong = wrong_scale(as_read);
  if (!wrong) return std::nullopt;
  return InputFinding{
      Fault::information_scale,
      fmt::format("the gaps of the loops fit best with the stated variances of {} times {:.1g} "
                  "(median of {} groups of loops)",
                  wrong->edges,
                  wrong->factor,
                  as_read.groups.size()),
      fmt::format("check the information of {}; for a trajectory: options {}",
                  wrong->edges,
                  wrong->options),
      0.8,
      wrong->factor};
}

}  // namespace loopbench::metrics
