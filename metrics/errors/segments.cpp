#include "metrics/errors/segments.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "datasets/core/parallel.hpp"
#include "metrics/evaluation/evaluation.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/numerics/euler.hpp"
#include "metrics/pairing/motion.hpp"
#include "metrics/pairing/pair_search.hpp"
#include "metrics/pairing/segment_ends.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench::metrics {
namespace {

/// Lists of equal length or empty. `start` is empty in float64. The last four are empty if only
/// rates are requested, and in float32.
struct SegmentErrors {
  std::vector<std::size_t> start;
  std::vector<double> translation_share;  ///< [m/m]
  std::vector<double> rotation_rate;      ///< [rad/m]
  std::vector<double> translation;        ///< [m]
  std::vector<double> rotation;           ///< [rad]
  std::vector<double> yaw;                ///< [rad], magnitude
  std::vector<double> gravity;            ///< [rad]
};

/// The printed matrices if the protocol evaluates them unchanged, otherwise null.
const PrintedPoses* printed(const Evaluation& evaluation) {
  const Protocol& p = evaluation.protocol;
  const bool is_unmoved = p.association == Association::index && p.align == Align::none &&
                          p.project == ProjectionPlane::none;
  const bool is_kitti = p.form == ErrorForm::kitti && p.angle == AngleFormula::trace;
  return is_unmoved && is_kitti ? evaluation.context.printed : nullptr;
}

PoseMatrix printed_error(const PrintedPoses& poses, std::size_t i, std::size_t j) {
  const auto& [Q, P] = poses;
  return (P[i].inverse() * P[j]).inverse() * (Q[i].inverse() * Q[j]);
}

/// Errors by the protocol, multi-threaded. Poses from KITTI files that were not moved since are
/// used with the printed digits and general matrix inverses, as in the devkit: converting them to
/// rotations first changes the mean angle by a relative 2e-9.
SegmentErrors segment_errors(const Evaluation& evaluation,
                             const std::vector<FromTo>& pairs,
                             double length,
                             bool only_rates) {
  const Protocol& protocol = evaluation.protocol;
  Rotation up_from_reference = Rotation::Identity();
  if (protocol.segments.up == PairsFrom::estimate) {
    up_from_reference = evaluation.alignment.reference_from_estimate.rotation.conjugate();
  }
  const PrintedPoses* const digits = printed(evaluation);
  SegmentErrors out;
  out.translation_share.resize(pairs.size());
  out.rotation_rate.resize(pairs.size());
  for (auto* more : {&out.translation, &out.rotation, &out.yaw, &out.gravity}) {
    if (!only_rates) more->resize(pairs.size());
  }
  const auto set = [&](std::size_t k) {
    const auto& [i, j] = pairs[k];
    const Pose& P_j = evaluation.estimate[j].world_from_body;
    Pose E = motion_error(protocol.form,
                          evaluation.reference[i].world_from_body,
                          evaluation.reference[j].world_from_body,
                          evaluation.estimate[i].world_from_body,
                          P_j);
    double radians = rotation_angle(protocol.angle, E.rotation);
    if (digits != nullptr) {
      const PoseMatrix exact = printed_error(*digits, i, j);
      E.translation = exact.translation();
      radians = trace_angle(exact.linear().trace());
    }
    const double metres = E.translation.norm();
    out.translation_share[k] = metres / length;
    out.rotation_rate[k] = radians / length;
    if (only_rates) return;
    const Rotation up_from_body = up_from_reference * P_j.rotation;
    const Euler turn = euler(up_from_body * E.rotation * up_from_body.conjugate());
    out.translation[k] = metres;
    out.rotation[k] = radians;
    out.yaw[k] = std::abs(turn.yaw);
    out.gravity[k] = std::hypot(turn.roll, turn.pitch);
  };
  parallel_for_blocks(pairs.size(), [&](std::size_t k, std::size_t end) {
    for (; k < end; ++k) set(k);
  });
  return out;
}

/// The devkit's float variant, with matrices as above: distances, angles and translation lengths in
/// float, transforms in double.
std::vector<float> float_distances(const Trajectory& trajectory) {
  std::vector<float> out{0.0F};
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const Vector3 step =
        trajectory[i - 1].world_from_body.translation - trajectory[i].world_from_body.translation;
    const auto dx = static_cast<float>(step.x());
    const auto dy = static_cast<float>(step.y());
    const auto dz = static_cast<float>(step.z());
    out.push_back(out.back() + std::sqrt(dx * dx + dy * dy + dz * dz));
  }
  return out;
}

SegmentErrors float_segment_errors(const Evaluation& evaluation,
                                   const std::vector<FromTo>& pairs,
                                   float length) {
  const PrintedPoses* const digits = printed(evaluation);
  SegmentErrors out;
  for (const auto& [i, j] : pairs) {
    PoseMatrix E;
    if (digits != nullptr) {
      E = printed_error(*digits, i, j);
    } else {
      const Pose rigid = motion_error(ErrorForm::kitti,
                                      evaluation.reference[i].world_from_body,
                                      evaluation.reference[j].world_from_body,
                                      evaluation.estimate[i].world_from_body,
                                      evaluation.estimate[j].world_from_body);
      E.linear() = rigid.rotation.toRotationMatrix();
      E.translation() = rigid.translation;
    }
    const auto a = static_cast<float>(E(0, 0));
    const auto b = static_cast<float>(E(1, 1));
    const auto c = static_cast<float>(E(2, 2));
    const auto cosine = static_cast<float>(0.5 * (static_cast<double>(a + b + c) - 1.0));
    const float radians = std::acos(std::max(std::min(cosine, 1.0F), -1.0F));
    const auto dx = static_cast<float>(E.translation().x());
    const auto dy = static_cast<float>(E.translation().y());
    const auto dz = static_cast<float>(E.translation().z());
    const float metres = std::sqrt(dx * dx + dy * dy + dz * dz);
    out.start.push_back(i);
    out.translation_share.push_back(static_cast<double>(metres / length));
    out.rotation_rate.push_back(static_cast<double>(radians / length));
  }
  return out;
}

/// Mean with a sequential sum in float.
double float_mean(const std::vector<double>& values) {
  float sum = 0.0F;
  for (const double value : values) sum += static_cast<float>(value);
  return static_cast<double>(sum / static_cast<float>(values.size()));
}

template <class T>
void append(std::vector<T>& list, const std::vector<T>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

/// The rates of several lengths, concatenated.
struct Together {
  SegmentErrors errors;

  /// `most`: number of segments that can be added in all; pages that are not written cost nothing.
  explicit Together(std::size_t most) {
    errors.translation_share.reserve(most);
    errors.rotation_rate.reserve(most);
  }

  void add(const SegmentErrors& more) {
    append(errors.start, more.start);
    append(errors.translation_share, more.translation_share);
    append(errors.rotation_rate, more.rotation_rate);
  }

  /// Ordered by start, the order in which the devkit sums floats.
  void sort() {
    std::vector<std::size_t> order(errors.start.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t k) { return errors.start[k]; });
    SegmentErrors sorted;
    for (const std::size_t k : order) {
      sorted.translation_share.push_back(errors.translation_share[k]);
      sorted.rotation_rate.push_back(errors.rotation_rate[k]);
    }
    errors = std::move(sorted);
  }
};

/// Adds scores of the values times `factor`.
struct Scores {
  const Protocol& protocol;
  std::vector<Score> out;

  void add(const char* relation,
           const std::string& axis,
           const char* unit,
           double factor,
           std::vector<double>&& values) {
    const bool is_float = protocol.segments.precision == Precision::float32;
    const double mean = is_float ? factor * float_mean(values) : 0.0;
    for (double& value : values) value *= factor;
    Score score{relation, axis, unit, statistics(std::move(values), protocol.ddof)};
    if (is_float) score.statistics.mean = mean;
    out.push_back(std::move(score));
  }

  /// Moves the two rates out of `errors`.
  void add_rates(const std::string& axis, SegmentErrors& errors) {
    add("translation", axis, "%", 100.0, std::move(errors.translation_share));
    add("rotation", axis, "deg/m", kDegrees, std::move(errors.rotation_rate));
  }
};

class Finder {
 public:
  explicit Finder(const Evaluation& evaluation)
      : evaluation_(evaluation), rule_(evaluation.protocol.segments) {
    if (rule_.precision == Precision::float32) {
      floats_ = float_distances(evaluation.reference);
    } else {
      distances_ = accumulated_distances(evaluation.reference);
    }
  }

  /// Computes only rates if single lengths are not reported.
  SegmentErrors errors(double length, bool only_rates) const {
    const auto step = static_cast<std::size_t>(rule_.step);
    if (rule_.precision == Precision::float32) {
      const auto wanted = static_cast<float>(length);
      return float_segment_errors(evaluation_, segments_beyond(floats_, wanted, step), wanted);
    }
    const double miss = tolerance("segments.tolerance", rule_.tolerance).of(length);
    const std::vector<FromTo> pairs = segment_pairs(distances_, length, miss, rule_.end, step);
    return segment_errors(evaluation_, pairs, length, only_rates);
  }

 private:
  const Evaluation& evaluation_;
  const SegmentErrorRule& rule_;
  std::vector<double> distances_;
  std::vector<float> floats_;
};

double metres(const Length& length, double whole) {
  return length.is_share ? std::floor(100.0 * length.of(whole)) / 100.0 : length.value;
}

}  // namespace

void check_combination(const SegmentsOptions& options) {
  if (!options.lengths.empty()) lengths("lengths", options.lengths);
}

std::vector<Score> segments(const Evaluation& evaluation, const SegmentsOptions& options) {
  const SegmentErrorRule& rule = evaluation.protocol.segments;
  const bool is_own = !options.lengths.empty();
  const std::vector<Length> wanted =
      is_own ? lengths("lengths", options.lengths) : lengths("segments.lengths", rule.lengths);
  if (const std::string why = why_no_attitude(evaluation); !why.empty()) throw Undefined(why);
  const Finder find(evaluation);
  Scores each{evaluation.protocol, {}};
  Together all(wanted.size() * evaluation.reference.size());
  for (const Length& length : wanted) {
    const double target = metres(length, evaluation.reference_length);
    if (target <= 0.0) continue;
    SegmentErrors errors = find.errors(target, !options.each);
    if (errors.rotation_rate.size() < static_cast<std::size_t>(rule.fewest)) continue;
    all.add(errors);
    if (!options.each) continue;
    each.add_rates(length.text, errors);
    if (rule.precision == Precision::float32) continue;
    each.add("translation", length.text, "m", 1.0, std::move(errors.translation));
    each.add("rotation", length.text, "deg", kDegrees, std::move(errors.rotation));
    each.add("yaw", length.text, "deg", kDegrees, std::move(errors.yaw));
    each.add("gravity", length.text, "deg", kDegrees, std::move(errors.gravity));
  }
  if (all.errors.rotation_rate.empty()) {
    std::string names;
    for (const Length& length : wanted) names += (names.empty() ? "" : ", ") + length.text;
    throw Undefined("no segment of the reference (" +
                    to_text(std::round(100.0 * evaluation.reference_length) / 100.0) +
                    " m) has a length of " + names);
  }
  Scores out{evaluation.protocol, {}};
  if (rule.precision == Precision::float32) all.sort();
  out.add_rates("all", all.errors);
  out.out.insert(out.out.end(), each.out.begin(), each.out.end());
  return out.out;
}

}  // namespace loopbench::metrics
