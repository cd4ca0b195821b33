#include "metrics/errors/rpe.hpp"

#include <cmath>
#include <stdexcept>

#include "datasets/core/parallel.hpp"
#include "metrics/errors/printed_motion.hpp"
#include "metrics/errors/relation.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/pairing/tum_motions.hpp"

namespace loopbench::metrics {
namespace {

/// The poses of reference and estimate at both ends of a pair.
struct PairedPoses {
  const Pose& Q_i;
  const Pose& Q_j;
  const Pose& P_i;
  const Pose& P_j;
};

/// Visits the four poses of every pair.
struct Motions {
  const Trajectory& reference;
  const Trajectory& estimate;
  const std::vector<FromTo>& pairs;
  const Protocol& protocol;
  std::string why_no_attitude;  ///< set for position-only files: scores with rotation are undefined
  std::optional<PrintedPoses> printed{};  ///< printed matrices of both files, where they are used

  PoseMatrix printed_error(std::size_t i, std::size_t j) const {
    const auto& [Q, P] = *printed;
    return printed_relative_pose(printed_relative_pose(Q[i], Q[j]),
                                 printed_relative_pose(P[i], P[j]));
  }

  Pose error(std::size_t i, std::size_t j) const {
    if (printed) return pose_of(printed_error(i, j));
    const auto [Q_i, Q_j, P_i, P_j] = poses(i, j);
    return motion_error(protocol.form, Q_i, Q_j, P_i, P_j);
  }

  PairedPoses poses(std::size_t i, std::size_t j) const {
    return {reference[i].world_from_body,
            reference[j].world_from_body,
            estimate[i].world_from_body,
            estimate[j].world_from_body};
  }

  /// visit(k, E, poses), multi-threaded: it may write only to slot k.
  template <class Visit>
  void each(Visit visit) const {
    parallel_for_blocks(pairs.size(), [&](std::size_t k, std::size_t end) {
      for (; k < end; ++k) {
        const auto& [i, j] = pairs[k];
        visit(k, error(i, j), poses(i, j));
      }
    });
  }

  /// The statistics of errors, or the reason why they are undefined.
  Score score(const char* relation,
              const char* axis,
              const char* unit,
              std::vector<double>&& errors,
              bool uses_attitude) const {
    if (uses_attitude && !why_no_attitude.empty())
      return {relation, axis, unit, {}, why_no_attitude};
    return {relation, axis, unit, statistics(std::move(errors), protocol.ddof)};
  }
};

std::vector<Score> usual(const Motions& motions, RpeFrame frame) {
  std::vector<double> metres(motions.pairs.size());
  std::vector<double> degrees(metres.size());
  std::array<std::vector<double>, 3> axes;
  for (std::vector<double>& axis : axes) axis.resize(metres.size());
  motions.each([&](std::size_t k, const Pose& E, const PairedPoses& poses) {
    const auto& [Q_i, Q_j, P_i, P_j] = poses;
    metres[k] = E.translation.norm();
    degrees[k] = kDegrees * rotation_angle(motions.protocol.angle, E.rotation);
    const Vector3 change =
        frame == RpeFrame::body
            ? E.translation
            : Vector3((P_j.translation - Q_j.translation) - (P_i.translation - Q_i.translation));
    for (int a = 0; a < 3; ++a) axes[static_cast<std::size_t>(a)][k] = std::abs(change[a]);
  });
  // |trans(E)| and the body frame depend on orientations; only the world axes do not.
  const bool in_body = frame == RpeFrame::body;
  return {motions.score("translation", "3d", "m", std::move(metres), true),
          motions.score("translation", "x", "m", std::move(axes[0]), in_body),
          motions.score("translation", "y", "m", std::move(axes[1]), in_body),
          motions.score("translation", "z", "m", std::move(axes[2]), in_body),
          motions.score("rotation", "3d", "deg", std::move(degrees), true)};
}

std::vector<Score> rpy(const Motions& motions, RpeFrame frame) {
  Rpy out(motions.pairs.size());
  motions.each([&](std::size_t k, const Pose& E, const PairedPoses& poses) {
    Rotation rotation = E.rotation;
    const Rotation& body = poses.P_j.rotation;
    if (frame == RpeFrame::world) rotation = body * rotation * body.conjugate();
    out.set(k, rotation);
  });
  return out.scores(motions.protocol.ddof);
}

std::vector<double> distances(const Motions& motions, Relation relation) {
  constexpr double kLeftOut = -1.0;  // marks skipped pairs; distances are not negative
  std::vector<double> out(motions.pairs.size(), kLeftOut);
  motions.each([&](std::size_t k, const Pose&, const PairedPoses& poses) {
    const auto& [Q_i, Q_j, P_i, P_j] = poses;
    const double reference = (Q_j.translation - Q_i.translation).norm();
    const double difference = std::abs(reference - (P_j.translation - P_i.translation).norm());
    if (relation == Relation::point_distance) {
      out[k] = difference;
    } else if (reference != 0.0) {
      out[k] = 100.0 * (difference / reference);
    }
  });
  std::erase(out, kLeftOut);
  if (out.empty()) throw Undefined("the reference does not move within any pair");
  return out;
}

/// The trajectory on which pairs were selected, the cause if there are too few.
enum class Measured { reference, estimate };

void require_pairs(std::size_t pairs,
                   std::size_t poses,
                   double min_pairs,
                   const RpeOptions& options,
                   Measured measured) {
  if (pairs > 0 && static_cast<double>(pairs) >= min_pairs) return;
  const std::string delta = to_text(options.delta) + " " + to_text(options.unit);
  const std::string found = std::to_string(pairs) + (pairs == 1 ? " pair " : " pairs ");
  const std::string why =
      pairs == 0 ? "none of " + std::to_string(poses) + " poses is " + delta + " before another"
                 : "found " + found + delta + " apart among " + std::to_string(poses) +
                       " poses, fewer than min_pairs = " +
                       std::to_string(std::llround(std::ceil(min_pairs)));
  if (measured == Measured::reference) throw Undefined(why);
  throw std::runtime_error(why);
}

std::vector<Score> scores(const Motions& motions,
                          std::size_t poses,
                          const RpeOptions& options,
                          Measured measured) {
  const double min_pairs = options.min_pairs.value_or(motions.protocol.min_pairs);
  require_pairs(motions.pairs.size(), poses, min_pairs, options, measured);
  const Relation relation = options.relation;
  if (relation == Relation::usual) return usual(motions, options.frame);
  const std::string& why = motions.why_no_attitude;
  const bool is_distance =
      relation == Relation::point_distance || relation == Relation::point_distance_error_ratio;
  if (!is_distance && !why.empty()) throw Undefined(why);
  if (relation == Relation::rpy) return rpy(motions, options.frame);
  std::vector<double> errors;
  if (is_distance) {
    errors = distances(motions, relation);
    require_pairs(errors.size(), poses, min_pairs, options, Measured::reference);
  } else {
    errors.resize(motions.pairs.size());
    const AngleFormula angle = motions.protocol.angle;
    motions.each([&](std::size_t k, const Pose& E, const PairedPoses&) {
      const auto& [i, j] = motions.pairs[k];
      errors[k] = motions.printed ? measure(relation, motions.printed_error(i, j), angle)
                                  : measure(relation, E, angle);
    });
  }
  return {{to_text(relation),
           "3d",
           unit(relation),
           statistics(std::move(errors), motions.protocol.ddof)}};
}

PairRule rule_of(const RpeOptions& options, const Protocol& protocol) {
  if (options.pairs == RpePairs::protocol) return protocol.pairs;
  if (options.pairs == RpePairs::all) return PairRule::all;
  if (options.pairs == RpePairs::consecutive) return PairRule::consecutive;
  check_protocol(options, protocol);
  return PairRule::tum;
}

TumMotions random_motions(const Paired& complete,
                          double offset,
                          const Alignment& alignment,
                          std::size_t max_pairs,
                          const RpeOptions& options) {
  if (options.delta != RpeOptions{}.delta || options.unit != RpeOptions{}.unit) {
    throw Undefined("pairs tum_random ignore delta = " + to_text(options.delta) + " " +
                    to_text(options.unit) + "; use rpe without delta and unit");
  }
  return tum_random_motions(complete, offset, alignment, max_pairs);
}

}  // namespace

void check_combination(const RpeOptions& options) {
  check(PairDelta{options.delta, options.unit, options.tolerance.value_or(0.0)});
}

void check_protocol(const RpeOptions& options, const Protocol& protocol) {
  if (options.pairs != RpePairs::tum || uses_complete_files(protocol.pairs)) return;
  throw OptionError("pairs", "pairs = tum: needs a protocol with pairs = tum");
}

std::vector<Score> rpe(const Evaluation& evaluation, const RpeOptions& options) {
  const Protocol& protocol = evaluation.protocol;
  const PairDelta pair_delta{
      options.delta, options.unit, options.tolerance.value_or(protocol.tolerance)};
  const PairRule rule = rule_of(options, protocol);
  if (uses_complete_files(rule)) {
    const Paired& complete = evaluation.complete;
    const Alignment& alignment = evaluation.alignment;
    const auto most = static_cast<std::size_t>(protocol.max_pairs);
    const TumMotions tum =
        rule == PairRule::tum ? tum_motions(complete, protocol.offset, alignment, pair_delta, most)
                              : random_motions(complete, protocol.offset, alignment, most, options);
    const auto& [reference, estimate] = tum.poses;
    return scores({reference, estimate, tum.pairs, protocol, why_no_attitude(evaluation)},
                  complete.estimate.size(),
                  options,
                  Measured::estimate);
  }
  const bool is_stated = options.pairs_from != RpePairsFrom::protocol;
  const auto of_protocol = protocol.pairs_from == PairsFrom::reference ? RpePairsFrom::reference
                                                                       : RpePairsFrom::estimate;
  const auto from = is_stated ? options.pairs_from : of_protocol;
  const bool is_in_time = options.unit == DeltaUnit::s || options.unit == DeltaUnit::frames;
  const bool is_of_reference = from == RpePairsFrom::reference;
  const std::vector<FromTo> pairs =
      select_pairs(evaluation.reference,
                   is_of_reference ? evaluation.reference : evaluation.estimate,
                   rule,
                   pair_delta);
  return scores({evaluation.reference,
                 evaluation.estimate,
                 pairs,
                 protocol,
                 why_no_attitude(evaluation),
                 printed_for_evo(evaluation)},
                evaluation.estimate.size(),
                options,
                is_in_time || is_of_reference ? Measured::reference : Measured::estimate);
}

}  // namespace loopbench::metrics
