#include "metrics/doctor/closure_checks.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "metrics/doctor/common_motion.hpp"

namespace loopbench::metrics {
namespace {

/// Composed odometry and its path length.
struct Chain {
  std::vector<Pose> poses;
  std::vector<double> lengths;       ///< up to each keyframe [m]
  std::vector<Matrix6> covariances;  ///< of the step to the next keyframe

  Pose between(std::size_t i, std::size_t j) const { return poses[i].inverse() * poses[j]; }
  double length(std::size_t i, std::size_t j) const { return std::abs(lengths[j] - lengths[i]); }
};

Chain chain_of(const Problem& problem) {
  Chain out;
  out.poses.resize(problem.keyframes.size());
  out.lengths.resize(problem.keyframes.size(), 0.0);
  for (std::size_t i = 0; i + 1 < out.poses.size() && i < problem.odometry.size(); ++i) {
    const Edge& step = problem.odometry[i];
    out.poses[i + 1] = normalized(out.poses[i] * step.from_from_to);
    out.lengths[i + 1] = out.lengths[i] + step.from_from_to.translation.norm();
    out.covariances.push_back(step.information.inverse());
  }
  return out;
}

/// Two closures between the same two stretches of the chain.
struct Rung {
  const Edge* a = nullptr;
  const Edge* b = nullptr;
};

std::size_t difference(std::size_t i, std::size_t j) { return i > j ? i - j : j - i; }

std::vector<Rung> rungs_of(const std::vector<Edge>& closures, const Chain& chain) {
  constexpr std::size_t kSearched = 12, kMostKeyframes = 15;
  constexpr double kMostMetres = 15.0;
  std::vector<Rung> out;
  for (std::size_t i = 0; i < closures.size(); ++i) {
    for (std::size_t j = i + 1; j < std::min(closures.size(), i + 1 + kSearched); ++j) {
      const Edge& a = closures[i];
      const Edge& b = closures[j];
      const bool is_near = difference(a.from, b.from) <= kMostKeyframes &&
                           difference(a.to, b.to) <= kMostKeyframes &&
                           chain.length(a.from, b.from) <= kMostMetres &&
                           chain.length(a.to, b.to) <= kMostMetres;
      if (is_near) {
        out.push_back({&a, &b});
        break;
      }
    }
  }
  return out;
}

/// Difference of closure `a` and the path over closure `b`; zero without noise.
Twist rung_residual(const Rung& rung, const Chain& chain, bool inverted) {
  const auto measured = [&](const Edge& edge) {
    return inverted ? edge.from_from_to.inverse() : edge.from_from_to;
  };
  const Pose around = chain.between(rung.a->from, rung.b->from) * measured(*rung.b) *
                      chain.between(rung.b->to, rung.a->to);
  return log_se3(measured(*rung.a).inverse() * around);
}

std::vector<InputFinding> check_direction(const std::vector<Edge>& closures,
                                          const std::vector<Rung>& rungs,
                                          const Chain& chain) {
  constexpr double kBetter = 0.5;
  constexpr std::size_t kFewest = 3;
  const auto median_of = [&](bool inverted, bool of_rotation) {
    std::vector<double> norms;
    for (const Rung& rung : rungs) {
      const Twist residual = rung_residual(rung, chain, inverted);
      norms.push_back(of_rotation ? residual.tail<3>().norm() : residual.head<3>().norm());
    }
    return median_value(std::move(norms));
  };
  if (rungs.size() < kFewest) {
    // Too few neighbours: an inverted closure is obvious only where drift is small against it.
    std::size_t inverted = 0, clear = 0;
    for (const Edge& edge : closures) {
      const Pose predicted = chain.between(edge.from, edge.to);
      const auto misfit = [&](const Pose& measured) {
        const Twist twist_of = log_se3(measured.inverse() * predicted);
        return twist_of.head<3>().norm() + 5.0 * twist_of.tail<3>().norm();
      };
      const double as_read = misfit(edge.from_from_to);
      const double turned = misfit(edge.from_from_to.inverse());
      if (std::min(as_read, turned) > 0.3 * std::max(as_read, turned)) continue;
      ++clear;
      inverted += turned < as_read ? 1 : 0;
    }
    if (clear == 0 || 2 * inverted <= clear) return {};
    return {{Fault::closure_direction,
             fmt::format("{} of {} closures fit the odometry much better after inversion",
                         inverted,
                         closures.size()),
             "exchange FROM and TO of the closures, or invert their poses",
             static_cast<double>(inverted) / static_cast<double>(closures.size()),
             static_cast<double>(inverted)}};
  }
  const double translation = median_of(false, false);
  const double translation_inverted = median_of(true, false);
  const double rotation = median_of(false, true);
  const double rotation_inverted = median_of(true, true);
  const bool is_inverted =
      translation_inverted < kBetter * translation && rotation_inverted < 1.2 * rotation + 1e-9;
  if (!is_inverted) return {};
  return {{Fault::closure_direction,
           fmt::format("neighbouring closures differ by {:.3g} m (median of {} pairs), after "
                       "inversion by {:.3g} m",
                       translation,
                       rungs.size(),
                       translation_inverted),
           "exchange FROM and TO of the closures, or invert their poses",
           1.0 - translation_inverted / translation,
           static_cast<double>(closures.size())}};
}

std::vector<InputFinding> check_gaps(const std::vector<Edge>& closures, const Chain& chain) {
  constexpr double kOfLength = 0.35, kLeast = 2.0, kOverUsual = 8.0;
  constexpr std::size_t kFewest = 4;
  // Drift per distance of most loops, if there are several.
  std::vector<double> drifts;
  for (const Edge& edge : closures) {
    const Pose gap = edge.from_from_to.inverse() * chain.between(edge.from, edge.to);
    drifts.push_back(gap.translation.norm() / std::max(1.0, chain.length(edge.from, edge.to)));
  }
  const double share = drifts.size() < kFewest
                           ? kOfLength
                           : std::min(kOfLength, kOverUsual * median_value(std::move(drifts)));
  std::size_t implausible = 0;
  const Edge* worst = nullptr;
  double largest = 0.0;
  for (const Edge& edge : closures) {
    const double length = chain.length(edge.from, edge.to);
    const double gap =
        (edge.from_from_to.inverse() * chain.between(edge.from, edge.to)).translation.norm();
    const double limit = kLeast + share * length;
    if (gap <= limit) continue;
    ++implausible;
    if (gap / limit > largest) {
      largest = gap / limit;
      worst = &edge;
    }
  }
  if (worst == nullptr) return {};
  const double length = chain.length(worst->from, worst->to);
  return {{Fault::closure_gap,
           fmt::format("{} of {} closures contradict the odometry, most of all {} -> {}: the gap "
                       "is {:.3g} m after {:.3g} m",
                       implausible,
                       closures.size(),
                       worst->from,
                       worst->to,
                       (worst->from_from_to.inverse() * chain.between(worst->from, worst->to))
                           .translation.norm(),
                       length),
           "remove false closures, or use a robust method",
           std::clamp(1.0 - 1.0 / largest, 0.0, 1.0),
           static_cast<double>(implausible)}};
}

/// Covariance of a rung's residual, to first order: both closures and the steps between them.
Matrix6 rung_covariance(const Rung& rung, const Chain& chain, bool exchanged) {
  const auto in_order = [&](Matrix6 matrix) -> Matrix6 {
    if (!exchanged) return matrix;
    const Matrix3 first = matrix.topLeftCorner<3, 3>();
    matrix.topLeftCorner<3, 3>() = matrix.bottomRightCorner<3, 3>();
    matrix.bottomRightCorner<3, 3>() = first;
    matrix.topRightCorner<3, 3>().setZero();
    matrix.bottomLeftCorner<3, 3>().setZero();
    return matrix;
  };
  const auto covariance = [&](const Edge& edge) -> Matrix6 {
    return in_order(edge.information.inverse());
  };
  const auto moved = [](const Pose& pose, const Matrix6& matrix) -> Matrix6 {
    const Matrix6 a = adjoint(pose);
    return a * matrix * a.transpose();
  };
  const Pose b_to_a = chain.between(rung.b->to, rung.a->to);
  Matrix6 out = covariance(*rung.a) + moved(b_to_a.inverse(), covariance(*rung.b));
  const auto add_steps = [&](std::size_t i, std::size_t j) {
    for (std::size_t k = std::min(i, j); k < std::max(i, j); ++k)
      out += in_order(chain.covariances[k]);
  };
  add_steps(rung.a->from, rung.b->from);
  add_steps(rung.a->to, rung.b->to);
  return out;
}

std::vector<InputFinding> check_information(const std::vector<Rung>& rungs, const Chain& chain) {
  constexpr std::size_t kFewest = 8;
  constexpr double kFar = 30.0;  // in variance
  if (rungs.size() < kFewest) return {};
  // Median squared residual per dimension over the stated variance; 0.79 for three dimensions.
  const auto ratios = [&](bool exchanged) {
    std::vector<double> translation, rotation;
    for (const Rung& rung : rungs) {
      const Twist residual = rung_residual(rung, chain, false);
      const Matrix6 covariance = rung_covariance(rung, chain, exchanged);
      translation.push_back(residual.head<3>().squaredNorm() /
                            covariance.topLeftCorner<3, 3>().trace());
      rotation.push_back(residual.tail<3>().squaredNorm() /
                         covariance.bottomRightCorner<3, 3>().trace());
    }
    return std::pair{median_value(std::move(translation)), median_value(std::move(rotation))};
  };
  const auto [translation, rotation] = ratios(false);
  const auto [translation_after, rotation_after] = ratios(true);
  const auto distance = [](double a, double b) {
    return std::abs(std::log(std::max(a, 1e-12))) + std::abs(std::log(std::max(b, 1e-12)));
  };
  const double before = distance(translation, rotation);
  const double after = distance(translation_after, rotation_after);
  if (before > std::log(kFar) && after < 0.5 * before) {
    return {{Fault::information_order,
             fmt::format("squared residuals over stated variances are {:.3g} (translation) and "
                         "{:.3g} (rotation); {:.3g} and {:.3g} after exchange of the blocks",
                         translation,
                         rotation,
                         translation_after,
                         rotation_after),
             "write the information in the order of the format: g2o has x y z first",
             1.0 - after / before,
             before}};
  }
  const bool is_small = translation > kFar && rotation > kFar;
  const bool is_large = translation < 1.0 / (kFar * kFar) && rotation < 1.0 / (kFar * kFar);
  if (!is_small && !is_large) return {};
  return {{Fault::information_scale,
           fmt::format("squared residuals are {:.3g} (translation) and {:.3g} (rotation) times the "
                       "stated variances (median of {} pairs of closures)",
                       translation,
                       rotation,
                       rungs.size()),
           is_small ? "the stated information is too large: divide it"
                    : "the stated information is too small: multiply it",
           0.8,
           translation}};
}

}  // namespace

std::vector<InputFinding> check_closures(const Problem& problem) {
  std::vector<InputFinding> out;
  const bool is_chain = problem.odometry.size() + 1 == problem.keyframes.size();
  if (problem.closures.empty() || !is_chain) return out;
  const Chain chain = chain_of(problem);
  const std::vector<Rung> rungs = rungs_of(problem.closures, chain);
  out = check_direction(problem.closures, rungs, chain);
  if (!out.empty()) return out;
  for (const auto& found : {check_gaps(problem.closures, chain), check_information(rungs, chain)}) {
    out.insert(out.end(), found.begin(), found.end());
  }
  return out;
}

}  // namespace loopbench::metrics
