#include "metrics/doctor/offset_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace loopbench::metrics {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

constexpr Index kCoarsePoints = 500;
constexpr double kLeastCommon = 0.3;  // of the shorter file
constexpr double kFarthest = 3.0;     // that an offset is refined by [steps]

SpeedGrid coarser(const SpeedGrid& fine, Index count) {
  return {fine.begin + 0.5 * static_cast<double>(count - 1) * fine.step,
          fine.step * static_cast<double>(count),
          fine.distance.coarser(count),
          fine.angle.coarser(count)};
}

/// Log-likelihood of a correlation of independent points, over that of none.
double likelihood_of(double correlation, double independent) {
  constexpr double kMost = 1.0 - 1e-6;  // speeds of the same motion differ by rounding
  const double r = std::clamp(correlation, 0.0, kMost);
  return -0.5 * independent * std::log1p(-r * r);
}

/// Values of a signal and of its derivative between the points of its grid: a cubic through four.
struct Shifted {
  ArrayXd value, slope, mask;

  /// At i + lag + u for i = 0, ... `count` - 1, with u in [0, 1). The slope is per step.
  Shifted(const GridSignal& signal, Index lag, double u, Index count)
      : value(ArrayXd::Zero(count)), slope(ArrayXd::Zero(count)), mask(ArrayXd::Zero(count)) {
    const std::array weights{-u * (u - 1.0) * (u - 2.0) / 6.0,
                             (u + 1.0) * (u - 1.0) * (u - 2.0) / 2.0,
                             -(u + 1.0) * u * (u - 2.0) / 2.0,
                             (u + 1.0) * u * (u - 1.0) / 6.0};
    const std::array slopes{-(3.0 * u * u - 6.0 * u + 2.0) / 6.0,
                            (3.0 * u * u - 4.0 * u - 1.0) / 2.0,
                            -(3.0 * u * u - 2.0 * u - 2.0) / 2.0,
                            (3.0 * u * u - 1.0) / 6.0};
    const Index begin = std::max<Index>(0, 1 - lag);
    const Index end = std::min(count, signal.value.size() - 2 - lag);
    if (end <= begin) return;
    const Index size = end - begin;
    mask.segment(begin, size).setOnes();
    for (Index j = 0; j < 4; ++j) {
      const Index from = begin + lag + j - 1;
      const auto k = static_cast<std::size_t>(j);
      value.segment(begin, size) += weights[k] * signal.value.segment(from, size);
      slope.segment(begin, size) += slopes[k] * signal.value.segment(from, size);
      mask.segment(begin, size) *= signal.mask.segment(from, size);
    }
  }
};

constexpr Index kParts = 20;

/// Sums over twenty parts of the normal equation of an offset: weighted residuals times slopes, and
/// the product of the slopes of both signals, in which independent noise cancels.
struct OffsetEquation {
  std::array<double, kParts> residuals{};
  double slopes = 0.0;

  /// Returns the correlation.
  Correlated add(const Shifted& a, const Shifted& b) {
    const ArrayXd common = a.mask * b.mask;
    const double points = common.sum();
    if (points < 2.0) return {};
    const double mean_a = (a.value * common).sum() / points;
    const double mean_b = (b.value * common).sum() / points;
    const ArrayXd of_a = (a.value - mean_a) * common, of_b = (b.value - mean_b) * common;
    const double squares = of_b.square().sum(), squares_of_a = of_a.square().sum();
    if (!(squares > 0.0 && squares_of_a > 0.0)) return {0.0, points};
    const double scale = (of_a * of_b).sum() / squares;
    const ArrayXd residual = of_a - scale * of_b;
    const double variance = std::max(residual.square().sum() / points, 1e-18);
    const ArrayXd slope = 0.5 * (a.slope + scale * b.slope) * common;
    slopes += (a.slope * b.slope * common).sum() * scale / variance;
    // Parts of equal length of the common time.
    Index first = 0, last = common.size();
    while (first < last && common[first] == 0.0) ++first;
    while (last > first && common[last - 1] == 0.0) --last;
    for (Index part = 0; part < kParts; ++part) {
      const Index from = first + (last - first) * part / kParts;
      const Index size = first + (last - first) * (part + 1) / kParts - from;
      residuals[static_cast<std::size_t>(part)] -=
          (residual.segment(from, size) * slope.segment(from, size)).sum() / variance;
    }
    return {scale * std::sqrt(squares / squares_of_a), points};
  }
};

}  // namespace

OffsetSearch::OffsetSearch(SpeedGrid reference, SpeedGrid estimate)
    : reference_(std::move(reference)),
      estimate_(std::move(estimate)),
      coarse_reference_(reference_),
      coarse_estimate_(estimate_) {
  const Index most =
      std::max(reference_.distance.value.size(), estimate_.distance.value.size()) / kCoarsePoints;
  const Index count = std::max(kWindowSteps / 2, most + 1);
  coarse_reference_ = coarser(reference_, count);
  coarse_estimate_ = coarser(estimate_, count);
  const auto dependent = [&](GridSignal SpeedGrid::*signal) {
    const double points = correlated_points(coarse_reference_.*signal, coarse_estimate_.*signal);
    return std::max(points * static_cast<double>(count), static_cast<double>(kWindowSteps));
  };
  of_distance_ = dependent(&SpeedGrid::distance);
  of_angle_ = dependent(&SpeedGrid::angle);
}

OffsetFit OffsetSearch::fit_at(const SpeedGrid& reference,
                               const SpeedGrid& estimate,
                               double per_point,
                               Index lag) const {
  const Correlated distance = correlation_at(reference.distance, estimate.distance, lag);
  const Correlated angle = correlation_at(reference.angle, estimate.angle, lag);
  OffsetFit out;
  out.offset = reference.begin - estimate.begin + static_cast<double>(lag) * reference.step;
  out.distance = distance.value;
  out.angle = angle.value;
  out.points = distance.points * per_point;
  out.likelihood = likelihood_of(distance.value, distance.points * per_point / of_distance_) +
                   likelihood_of(angle.value, angle.points * per_point / of_angle_);
  return out;
}

OffsetFit OffsetSearch::at(double offset) const {
  const double lag = offset / reference_.step + zero_lag();
  return fit_at(reference_, estimate_, 1.0, std::lround(lag));
}

std::vector<OffsetFit> OffsetSearch::best() const {
  constexpr std::size_t kCandidates = 6, kReturned = 3;
  constexpr double kApart = 2.0 * kWindowSteps;  // [steps]
  constexpr double kNear = 1.0, kRarer = 2.0;    // [s]; larger offsets are rarer
  constexpr double kAgrees = 0.97;               // correlation at most a second from zero
  const SpeedGrid& a = coarse_reference_;
  const SpeedGrid& b = coarse_estimate_;
  const double count = std::round(a.step / reference_.step);
  const auto likely = [&](OffsetFit fit) {
    if (std::abs(fit.offset) > kNear) fit.likelihood -= kRarer;
    return fit;
  };
  const auto best_near = [&](double offset, Index range) {
    OffsetFit best{.offset = offset, .likelihood = -1.0};
    const auto middle = std::lround(offset / reference_.step + zero_lag());
    for (Index lag = middle - range; lag <= middle + range; ++lag) {
      const OffsetFit fit = likely(fit_at(reference_, estimate_, 1.0, lag));
      if (fit.likelihood > best.likelihood) best = fit;
    }
    return best;
  };
  // Of files that agree as read, only the rest is of interest.
  const OffsetFit as_read = best_near(0.0, kWindowSteps);
  const double least_points = 0.5 * std::min(reference_.distance.mask.sum(), size());
  if (as_read.points >= least_points && std::max(as_read.distance, as_read.angle) > kAgrees) {
    // Speeds that change slowly agree far from their largest correlation, too.
    if (const auto fit = refined(as_read)) return {*fit};
  }
  const double least =
      kLeastCommon * std::min(a.distance.mask.sum(), b.distance.mask.sum()) * count;
  std::vector<OffsetFit> rough;
  for (Index lag = -b.distance.value.size(); lag <= a.distance.value.size(); ++lag) {
    const OffsetFit fit = likely(fit_at(a, b, count, lag));
    if (fit.points >= least) rough.push_back(fit);
  }
  std::vector<OffsetFit> peaks;
  for (std::size_t i = 0; i < rough.size(); ++i) {
    const bool rises = i == 0 || rough[i].likelihood >= rough[i - 1].likelihood;
    const bool falls = i + 1 == rough.size() || rough[i].likelihood > rough[i + 1].likelihood;
    if (rises && falls) peaks.push_back(rough[i]);
  }
  const auto by_likelihood = [](const OffsetFit& x, const OffsetFit& y) {
    return x.likelihood > y.likelihood;
  };
  std::ranges::sort(peaks, by_likelihood);
  if (peaks.size() > kCandidates) peaks.resize(kCandidates);
  peaks.push_back(at(0.0));
  std::vector<OffsetFit> out;
  for (const OffsetFit& peak : peaks) {
    const OffsetFit best = best_near(peak.offset, static_cast<Index>(count));
    const bool is_known = std::ranges::any_of(out, [&](const OffsetFit& each) {
      return std::abs(each.offset - best.offset) < kApart * reference_.step;
    });
    if (best.points > 2.0 && !is_known) out.push_back(best);
  }
  std::ranges::sort(out, by_likelihood);
  if (out.size() > kReturned) out.resize(kReturned);
  for (OffsetFit& each : out) {
    each.deviation = kFarthest * reference_.step;
    if (const auto fit = refined(each)) each = likely(*fit);
  }
  std::ranges::sort(out, by_likelihood);
  return out;
}

std::optional<OffsetFit> OffsetSearch::refined(const OffsetFit& start) const {
  constexpr int kRounds = 8;
  constexpr double kConverged = 1e-4;  // [steps]
  const double first = start.offset / reference_.step + zero_lag();
  double at = first;
  OffsetEquation equation;
  const Index count = estimate_.distance.value.size();
  std::array<Correlated, 2> found;
  for (int round = 0; round < kRounds; ++round) {
    equation = {};
    const double below = std::floor(at);
    const auto lag = static_cast<Index>(below);
    std::size_t k = 0;
    for (GridSignal SpeedGrid::*signal : {&SpeedGrid::distance, &SpeedGrid::angle}) {
      const Shifted a(reference_.*signal, lag, at - below, count);
      const Shifted b(estimate_.*signal, 0, 0.0, count);
      found[k++] = equation.add(a, b);
    }
    double sum = 0.0;
    for (const double part : equation.residuals) sum += part;
    if (!(equation.slopes > 0.0)) return std::nullopt;
    const double change = sum / equation.slopes;
    if (std::abs(change) < kConverged) break;
    at += std::clamp(change, -1.0, 1.0);
    if (!(std::abs(at - first) < kFarthest)) return std::nullopt;
  }
  OffsetFit out = start;
  double squares = 0.0;
  for (const double part : equation.residuals) squares += part * part;
  out.offset = (at - zero_lag()) * reference_.step;
  out.deviation = reference_.step * std::sqrt(squares * kParts / (kParts - 1.0)) / equation.slopes;
  out.distance = found[0].value;
  out.angle = found[1].value;
  out.points = found[0].points;
  out.likelihood = likelihood_of(out.distance, out.points / of_distance_) +
                   likelihood_of(out.angle, found[1].points / of_angle_);
  return out;
}

}  // namespace loopbench::metrics
