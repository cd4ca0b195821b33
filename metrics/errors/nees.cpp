#include "metrics/errors/nees.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/errors/weighted_alignment.hpp"
#include "metrics/numerics/autocorrelation.hpp"
#include "metrics/numerics/average.hpp"

namespace loopbench::metrics {
namespace {

constexpr double kTwoSided95 = 1.959963984540054;  // standard normal quantile at 97.5 %

/// Squared radii of the regions of these probabilities, by degrees of freedom.
struct Region {
  int percent;
  double one, two, three, six;
  double squared_radius(int freedom) const {
    if (freedom == 1) return one;
    if (freedom == 2) return two;
    return freedom == 3 ? three : six;
  }
};
constexpr std::array kRegions{
    Region{50, 0.4549364231195727, 1.386294361119891, 2.365973884375338, 5.348120627447120},
    Region{90, 2.705543454095414, 4.605170185988092, 6.251388631170324, 10.644640675668420},
    Region{95, 3.841458820694124, 5.991464547107980, 7.814727903251178, 12.591587243743977}};

/// Squared normalised errors of one part of the pose.
struct NormalisedErrors {
  std::string part;
  std::vector<int> axes;  ///< of the error [position; rotation]
  bool is_axis = false;   ///< one of a part with several
  std::vector<double> squares = {};
  int freedom() const { return static_cast<int>(axes.size()); }
};

/// What the covariances of an estimate describe.
enum class Stated { positions, planar, poses };

/// Planar: all variances of z, roll and pitch are zero beside the others (up to rounding).
Stated stated(const std::vector<Matrix6>& covariances, bool has_rotations) {
  Twist largest = Twist::Zero();
  for (const Matrix6& each : covariances) largest = largest.cwiseMax(each.diagonal());
  if (!has_rotations || largest.tail<3>().isZero(0.0)) return Stated::positions;
  constexpr double kRounding = 1e-18;
  const bool is_flat = largest[2] <= kRounding * largest.head<2>().maxCoeff() &&
                       largest.segment<2>(3).maxCoeff() <= kRounding * largest[5];
  return is_flat ? Stated::planar : Stated::poses;
}

std::vector<NormalisedErrors> parts_of(Stated what) {
  std::vector<NormalisedErrors> out;
  std::vector<int> all{0, 1, 2, 3, 4, 5};
  if (what == Stated::positions) {
    out = {{"position", {0, 1, 2}}};
  } else if (what == Stated::planar) {
    out = {{"pose", {0, 1, 5}}, {"position", {0, 1}}, {"rotation", {5}}};
  } else {
    out = {{"pose", all}, {"position", {0, 1, 2}}, {"rotation", {3, 4, 5}}};
  }
  constexpr std::array kAxes{"x", "y", "z", "rx", "ry", "rz"};
  const std::vector<int> axes = out.front().axes;
  for (const int axis : axes) out.push_back({kAxes[static_cast<std::size_t>(axis)], {axis}, true});
  return out;
}

double variance_of(const std::vector<double>& values) {
  const double middle = mean(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - middle) * (value - middle);
  return sum / static_cast<double>(values.size());
}

double independent_values(const std::vector<double>& values) {
  return static_cast<double>(values.size()) / integrated_autocorrelation(values);
}

/// The type of the alignment that a gauge states.
Align type_of(Gauge gauge, Align protocol) {
  switch (gauge) {
    case Gauge::none:
      return Align::none;
    case Gauge::origin:
      return Align::origin;
    case Gauge::posyaw:
      return Align::posyaw;
    case Gauge::se3:
      return Align::se3;
    case Gauge::sim3:
      return Align::sim3;
    case Gauge::weighted:
    case Gauge::protocol:
      break;
  }
  return protocol;
}

/// The estimate before the protocol's alignment.
Trajectory unaligned(const Evaluation& evaluation) {
  Trajectory out = evaluation.estimate;
  const Alignment& fit = evaluation.alignment;
  const Pose estimate_from_reference = fit.reference_from_estimate.inverse();
  for (auto& [stamp, pose] : out) {
    pose = estimate_from_reference * pose;
    pose.translation /= fit.scale;
  }
  return out;
}

double squared_norm(const Twist& error,
                    const Matrix6& covariance,
                    const std::vector<int>& axes,
                    double stamp) {
  if (axes.size() == 1) return error[axes[0]] * error[axes[0]] / covariance(axes[0], axes[0]);
  using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
  const CovarianceRoot<Block> root = covariance_root(Block(covariance(axes, axes)), stamp);
  return root.matrixL().solve(error(axes)).squaredNorm();
}

std::vector<NormalisedErrors> normalised_errors(const Evaluation& evaluation,
                                                Gauge gauge,
                                                Stated what,
                                                Align& type) {
  const bool has_rotations = what != Stated::positions;
  type = type_of(gauge, evaluation.alignment.type);
  const bool is_first_exact = type == Align::origin || type == Align::posyaw_origin;
  const Context& context = evaluation.context;
  if (!is_first_exact && context.reference_covariances == nullptr &&
      covariance_at(
          *context.estimate, *context.estimate_covariances, evaluation.estimate.front().stamp)
          .isZero(0.0)) {
    throw Undefined("covariances are relative to the first pose, which needs gauge origin");
  }
  if (what == Stated::planar && !free_columns(type).empty() && gauge != Gauge::protocol) {
    throw Undefined("planar covariances have no weighted alignment, expected gauge origin");
  }
  Trajectory estimate = evaluation.estimate;
  Alignment alignment = evaluation.alignment;
  if (gauge != Gauge::protocol) {
    const Trajectory raw = unaligned(evaluation);
    if (gauge != Gauge::weighted) alignment = align(evaluation.reference, raw, type);
    alignment = weighted_alignment(evaluation, raw, alignment, has_rotations);
    estimate = moved(alignment, raw);
  }
  const PairCovariance covariance(evaluation, alignment);
  std::vector<NormalisedErrors> out = parts_of(what);
  for (std::size_t i = is_first_exact ? 1 : 0; i < estimate.size(); ++i) {
    const auto& [stamp, reference] = evaluation.reference[i];
    const Twist error = error_of(reference, estimate[i].world_from_body, has_rotations);
    const Matrix6 C = covariance.at(stamp, estimate[i].stamp);
    for (NormalisedErrors& each : out) {
      each.squares.push_back(squared_norm(error, C, each.axes, stamp));
    }
  }
  if (out.front().squares.empty()) throw Undefined("no pair remains besides the origin");
  return out;
}

/// Sum over its degrees of freedom, with the interval of a scaled chi-squared variable of the same
/// mean and variance (quantiles of Wilson and Hilferty).
void add_ratio(std::vector<Score>& out, const NormalisedErrors& errors, int fitted_freedom) {
  const auto n = static_cast<double>(errors.squares.size());
  const double freedom = n * errors.freedom() - fitted_freedom;
  if (!(freedom > 0.0)) {
    out.push_back({"nees_ratio", errors.part, "1", {}, "the alignment fits all errors"});
    return;
  }
  const double average = mean(errors.squares);
  const double ratio = n * average / freedom;
  const double of_mean = variance_of(errors.squares) / independent_values(errors.squares);
  const double equivalent = of_mean > 0.0 ? 2.0 * average * average / of_mean : 1e12;
  const auto bound = [&](double z) {
    const double v = 2.0 / (9.0 * equivalent);
    return ratio / std::pow(std::max(1.0 - v + z * std::sqrt(v), 1e-3), 3.0);
  };
  out.push_back(directed(single("nees_ratio", errors.part, "1", ratio), Better::target, 1.0));
  for (const auto& [name, z] : {std::pair{"low", kTwoSided95}, std::pair{"high", -kTwoSided95}}) {
    const std::string relation = std::string("nees_ratio_") + name;
    out.push_back(directed(single(relation, errors.part, "1", bound(z)), Better::neither));
  }
}

std::vector<double> inside(const NormalisedErrors& errors, double squared_radius) {
  std::vector<double> out;
  for (const double square : errors.squares) out.push_back(square <= squared_radius ? 1.0 : 0.0);
  return out;
}

Score coverage_score(int percent, const std::string& axis, double share) {
  return directed(single("coverage_" + std::to_string(percent), axis, "%", 100.0 * share),
                  Better::target,
                  percent);
}

/// Wilson's interval for as many independent pairs as the autocorrelation leaves.
void add_interval(std::vector<Score>& out, const NormalisedErrors& errors, const Region& region) {
  const std::vector<double> hits = inside(errors, region.squared_radius(errors.freedom()));
  const double n = independent_values(hits);
  const double z2 = kTwoSided95 * kTwoSided95;
  const double p = mean(hits);
  const double middle = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
  const double half =
      kTwoSided95 * std::sqrt(p * (1.0 - p) / n + z2 / (4.0 * n * n)) / (1.0 + z2 / n);
  const std::string name = "coverage_" + std::to_string(region.percent);
  out.push_back(
      directed(single(name + "_low", errors.part, "%", 100.0 * (middle - half)), Better::neither));
  out.push_back(
      directed(single(name + "_high", errors.part, "%", 100.0 * (middle + half)), Better::neither));
}

void add_thirds(std::vector<Score>& out, const NormalisedErrors& errors, const Region& region) {
  const std::vector<double> hits = inside(errors, region.squared_radius(errors.freedom()));
  const std::size_t n = hits.size();
  if (n < 3) return;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::vector<double> part(hits.begin() + static_cast<std::ptrdiff_t>(k * n / 3),
                                   hits.begin() + static_cast<std::ptrdiff_t>((k + 1) * n / 3));
    out.push_back(coverage_score(region.percent, fmt::format("third {}", k + 1), mean(part)));
  }
}

}  // namespace

std::vector<Score> nees(const Evaluation& evaluation, const NeesOptions& options) {
  if (evaluation.context.estimate_covariances == nullptr) {
    throw Undefined("the estimate states no covariances");
  }
  if (evaluation.protocol.project != ProjectionPlane::none) {
    throw Undefined("covariances are not projected");
  }
  std::string why_no_rotation = why_no_attitude(evaluation);
  const Stated what = stated(*evaluation.context.estimate_covariances, why_no_rotation.empty());
  if (why_no_rotation.empty() && what == Stated::positions) {
    why_no_rotation = "the covariances of the estimate are those of positions";
  }
  Align type{};
  const std::vector<NormalisedErrors> all =
      normalised_errors(evaluation, options.gauge, what, type);
  // The weighted alignment fits the first part, the protocol's least squares the positions.
  const auto fitted = static_cast<int>(free_columns(type).size());
  const std::string fitted_part = options.gauge == Gauge::protocol ? "position" : all.front().part;
  std::vector<Score> out;
  const int ddof = evaluation.protocol.ddof;
  for (const NormalisedErrors& errors : all) {
    const bool is_part = !errors.is_axis;
    if (is_part) {
      Score each{"nees", errors.part, "1", statistics(errors.squares, ddof)};
      out.push_back(directed(std::move(each), Better::neither));
      add_ratio(out, errors, errors.part == fitted_part ? fitted : 0);
    }
    for (const Region& region : kRegions) {
      const double share = mean(inside(errors, region.squared_radius(errors.freedom())));
      out.push_back(coverage_score(region.percent, errors.part, share));
      if (is_part && region.percent == 95) add_interval(out, errors, region);
    }
  }
  add_thirds(out, all.front(), kRegions.back());
  out.push_back(directed(single("independent", "", "1", independent_values(all.front().squares)),
                         Better::neither));
  for (const char* part : {"pose", "rotation"}) {
    if (what == Stated::positions)
      out.push_back({"nees", part, "1", {}, why_no_rotation, Better::neither});
  }
  return out;
}

}  // namespace loopbench::metrics
