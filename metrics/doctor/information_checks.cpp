#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <vector>

#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/graph_checks.hpp"
#include "metrics/doctor/loop_likelihood.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

/// The loops of a problem in groups, and the noise that fits each; loops alone if there are few, so
/// that a false one among them is outvoted.
struct GroupFits {
  explicit GroupFits(const Problem& problem)
      : chain(chain_of(problem)),
        groups(loop_groups(problem.closures, chain, problem.closures.size() < 6 ? 1 : 5)) {
    for (const LoopGroup& group : groups) fits.push_back(group.fit(group.as_read()));
  }

  Chain chain;
  std::vector<LoopGroup> groups;
  std::vector<LoopFit> fits;
};

/// Closures that are as wrong as they are long, whatever the noise.
std::optional<InputFinding> contradiction(const GroupFits& loops) {
  constexpr double kMostOfLength = 0.5, kMostAngle = 0.1;  // [-], [rad]
  constexpr std::size_t kFewest = 6;                       // drift of long loops
  std::vector<double> metres, radians, lengths;
  for (std::size_t i = 0; i < loops.groups.size(); ++i) {
    std::ranges::copy(loops.fits[i].metres, std::back_inserter(metres));
    std::ranges::copy(loops.fits[i].radians, std::back_inserter(radians));
    for (const Edge* edge : loops.groups[i].closures()) {
      lengths.push_back(edge->from_from_to.translation.norm());
    }
  }
  const std::size_t count = lengths.size();
  if (count < kFewest) return std::nullopt;
  const double error = median_value(std::move(metres)), angle = median_value(std::move(radians));
  const double length = median_value(std::move(lengths));
  if (error < kMostOfLength * length || angle < kMostAngle) return std::nullopt;
  return InputFinding{
      Fault::closure_gap,
      fmt::format("the {} closures that were compared contradict the odometry and each other: "
                  "median error {:.3g} m, {:.3g} deg, median length {:.3g} m",
                  count,
                  error,
                  kDegrees * angle,
                  length),
      "check the numbers or stamps of their vertices, and that they are of this trajectory",
      0.8,
      static_cast<double>(count)};
}

/// Edges whose variances are wrong by the median factors of every other group; these have to make
/// the remaining groups likelier (all, if there are few).
std::optional<InputFinding> wrong_scale(const GroupFits& loops) {
  constexpr double kTooSmall = 100.0, kTooLarge = 1e-5;  // fitted over stated variance
  constexpr double kMostContradicted = 1e5;
  constexpr double kExact = 1e-8;  // smaller ones are those of closures without noise
  constexpr double kSmallLoss = 15.0, kLeastProven = 3.0;  // in logarithms of the likelihood
  const std::size_t step = loops.groups.size() < 6 ? 1 : 2;
  const auto factor = [&](std::size_t kind) {
    std::vector<double> logarithms;
    for (std::size_t i = 0; i < loops.fits.size(); i += step) {
      logarithms.push_back(loops.fits[i].factors[kind]);
    }
    std::ranges::sort(logarithms, {}, [](double x) { return std::abs(x); });
    return logarithms[(logarithms.size() - 1) / 2];  // of two, the one that accuses less
  };
  const auto gain_by = [&](const std::array<double, 2>& factors) {
    double out = 0.0;
    for (std::size_t i = step - 1; i < loops.groups.size(); i += step) {
      out += loops.groups[i].log_likelihood(factors) - loops.groups[i].log_likelihood({});
    }
    return out;
  };
  const double f = factor(0), c = factor(1);
  const bool is_odometry = std::exp(f) < kTooLarge || std::exp(f) > kTooSmall;
  const bool is_closures =
      std::exp(c) > kTooSmall || (std::exp(c) < kTooLarge && std::exp(c) > kExact);
  if (!is_odometry && !is_closures) return std::nullopt;
  const double most_loss = kSmallLoss * static_cast<double>(loops.groups.size() / step);
  const std::array<double, 2> of_all{f, f}, of_some{is_odometry ? f : 0.0, is_odometry ? 0.0 : c};
  const bool is_all =
      std::abs(f) > std::log(kTooSmall) && gain_by(of_some) - gain_by(of_all) < most_loss;
  const double proven = gain_by(is_all ? of_all : of_some);
  if (proven < kLeastProven) return std::nullopt;
  const double scale = std::exp(is_all || is_odometry ? f : c);
  if (scale > kTooSmall && scale < kMostContradicted) {
    if (auto found = contradiction(loops)) return found;
  }
  const char* const edges = is_all ? "all edges" : is_odometry ? "the odometry" : "the closures";
  return InputFinding{
      Fault::information_scale,
      fmt::format("the gaps of the loops are likelier with the stated variances of {} times {:.1g} "
                  "(median of {} groups of loops; logarithm of the ratio of likelihoods {:.1f})",
                  edges,
                  scale,
                  loops.groups.size(),
                  proven),
      fmt::format("check the information of {}; for a trajectory: options {}{}",
                  edges,
                  is_all || is_odometry ? "odometry.sigma_*" : "closures.sigma_*",
                  is_all ? ", closures.sigma_*" : ""),
      0.8,
      scale};
}

}  // namespace

std::optional<InputFinding> check_information(const Problem& problem) {
  constexpr std::size_t kFewest = 2;
  // Means of the groups, in logarithms of the likelihood.
  constexpr double kLeastOfOrder = 18.0, kLeastOfStated = 1.5, kLeastStated = 20.0,
                   kMostLeft = 40.0;
  constexpr double kFewestGroups = 6.0;
  constexpr double kExactGap = 1e-4;  // [m]; of measurements without noise
  if (problem.closures.size() < kFewest) return std::nullopt;
  const GroupFits as_read(problem);
  std::vector<double> gaps;
  for (const Edge& closure : problem.closures)
    gaps.push_back(loop_residual(closure, as_read.chain).translation.norm());
  if (median_value(std::move(gaps)) < kExactGap) return std::nullopt;
  struct Gain {
    double fitted = 0.0, stated = 0.0;  // with factors of the variances, and without
    double left = 0.0;                  // by the factors, after the change
  };
  const auto gained_by = [&](auto change) {
    Problem other = problem;
    for (auto* edges : {&other.odometry, &other.closures}) {
      for (Edge& edge : *edges) edge.information = change(edge.information);
    }
    const GroupFits changed(other);
    Gain out{gain(as_read.fits, changed.fits)};
    for (std::size_t i = 0; i < changed.groups.size(); ++i) {
      out.stated += changed.groups[i].log_likelihood({}) - as_read.groups[i].log_likelihood({});
      out.left += changed.fits[i].log_likelihood - changed.groups[i].log_likelihood({});
    }
    return out;
  };
  const Gain exchanged = gained_by([](const Matrix6& information) -> Matrix6 {
    const std::array order{3, 4, 5, 0, 1, 2};
    return information(order, order);
  });
  const Gain inverted =
      gained_by([](const Matrix6& information) -> Matrix6 { return information.inverse(); });
  const auto groups = static_cast<double>(as_read.groups.size());
  const bool fits_as_stated = exchanged.fitted > kLeastOfStated * groups &&
                              exchanged.stated > kLeastStated * groups &&
                              exchanged.left < kMostLeft * groups && groups >= kFewestGroups;
  const double gained =
      fits_as_stated ? exchanged.stated : std::max(exchanged.fitted, inverted.fitted);
  if (gained > kLeastOfOrder * groups) {
    const bool is_order = fits_as_stated || exchanged.fitted >= inverted.fitted;
    return InputFinding{
        is_order ? Fault::information_order : Fault::information_scale,
        fmt::format("{}: logarithm of the ratio of likelihoods of {} groups of loops {:.1f}",
                    is_order ? "exchanging the blocks of translation and rotation"
                             : "inverting the information",
                    as_read.groups.size(),
                    gained),
        is_order ? "check the order of the blocks: g2o has those of x y z first"
                 : "write information, the inverse of covariances",
        1.0 - std::exp(-0.25 * gained),
        gained};
  }
  return wrong_scale(as_read);
}

}  // namespace loopbench::metrics
