#include "metrics/rpe.hpp"

#include <cmath>
#include <stdexcept>

#include "metrics/angle.hpp"
#include "metrics/pairs/tum_motions.hpp"
#include "metrics/rpy.hpp"

namespace loopbench {
namespace {

/// Four poses at a time, over all pairs.
struct Motions {
  const Trajectory& reference;
  const Trajectory& estimate;
  const std::vector<FromTo>& pairs;
  const Protocol& protocol;

  /// visit(k, E, Q_i, Q_j, P_i, P_j)
  template <class Visit>
  void each(Visit visit) const {
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto& [i, j] = pairs[k];
      const Pose& Q_i = reference[i].world_from_body;
      const Pose& Q_j = reference[j].world_from_body;
      const Pose& P_i = estimate[i].world_from_body;
      const Pose& P_j = estimate[j].world_from_body;
      visit(k, motion_error(protocol.form, Q_i, Q_j, P_i, P_j), Q_i, Q_j, P_i, P_j);
    }
  }
};

std::vector<Score> usual(const Motions& motions, RpeFrame frame) {
  std::vector<double> metres(motions.pairs.size());
  std::vector<double> degrees(metres.size());
  std::array<std::vector<double>, 3> axes;
  for (std::vector<double>& axis : axes) axis.resize(metres.size());
  motions.each([&](std::size_t k,
                   const Pose& E,
                   const Pose& Q_i,
                   const Pose& Q_j,
                   const Pose& P_i,
                   const Pose& P_j) {
    metres[k] = E.translation.norm();
    degrees[k] = kDegrees * rotation_angle(motions.protocol.angle, E.rotation);
    const Vector3 change =
        frame == RpeFrame::body
            ? E.translation
            : Vector3((P_j.translation - Q_j.translation) - (P_i.translation - Q_i.translation));
    for (int a = 0; a < 3; ++a) axes[static_cast<std::size_t>(a)][k] = std::abs(change[a]);
  });
  const int ddof = motions.protocol.ddof;
  return {{"translation", "3d", "m", statistics(std::move(metres), ddof)},
          {"translation", "x", "m", statistics(std::move(axes[0]), ddof)},
          {"translation", "y", "m", statistics(std::move(axes[1]), ddof)},
          {"translation", "z", "m", statistics(std::move(axes[2]), ddof)},
          {"rotation", "3d", "deg", statistics(std::move(degrees), ddof)}};
}

std::vector<Score> rpy(const Motions& motions, RpeFrame frame) {
  Rpy out(motions.pairs.size());
  motions.each(
      [&](std::size_t k, const Pose& E, const Pose&, const Pose&, const Pose&, const Pose& P_j) {
        Rotation turn = E.rotation;
        if (frame == RpeFrame::world) turn = P_j.rotation * turn * P_j.rotation.conjugate();
        out.set(k, turn);
      });
  return out.scores(motions.protocol.ddof);
}

std::vector<double> distances(const Motions& motions, Relation relation) {
  std::vector<double> out;
  motions.each([&](std::size_t,
                   const Pose&,
                   const Pose& Q_i,
                   const Pose& Q_j,
                   const Pose& P_i,
                   const Pose& P_j) {
    const double reference = (Q_j.translation - Q_i.translation).norm();
    const double difference = std::abs(reference - (P_j.translation - P_i.translation).norm());
    if (relation == Relation::point_distance) {
      out.push_back(difference);
    } else if (reference != 0.0) {
      out.push_back(100.0 * (difference / reference));
    }
  });
  if (out.empty()) throw std::runtime_error("rpe: the reference stands still in every pair");
  return out;
}

std::vector<Score> scores(const Motions& motions, const RpeOptions& options, std::size_t poses) {
  if (motions.pairs.empty()) {
    throw std::runtime_error("rpe: none of " + std::to_string(poses) + " poses is " +
                             to_text(options.delta) + " " + to_text(options.unit) +
                             " before another");
  }
  const Relation relation = options.relation;
  if (relation == Relation::usual) return usual(motions, options.frame);
  if (relation == Relation::rpy) return rpy(motions, options.frame);
  std::vector<double> errors;
  if (relation == Relation::point_distance || relation == Relation::point_distance_error_ratio) {
    errors = distances(motions, relation);
  } else {
    errors.resize(motions.pairs.size());
    motions.each([&](std::size_t k, const Pose& E, const auto&...) {
      errors[k] = measure(relation, E, motions.protocol.angle);
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
  if (protocol.pairs == PairRule::tum) return PairRule::tum;
  throw OptionError("pairs", "pairs = tum: looks at whole files; only a protocol can ask for it");
}

}  // namespace

std::vector<Score> rpe(const Evaluation& evaluation, const RpeOptions& options) {
  const Protocol& protocol = evaluation.protocol;
  const Stretch stretch{
      options.delta, options.unit, options.tolerance.value_or(protocol.tolerance)};
  const PairRule rule = rule_of(options, protocol);
  if (rule == PairRule::tum) {
    const TumMotions tum =
        tum_motions(evaluation.whole, protocol.offset, evaluation.alignment, stretch);
    const auto& [reference, estimate] = tum.poses;
    return scores({reference, estimate, tum.pairs, protocol}, options, estimate.size());
  }
  const auto from = options.pairs_from != RpePairsFrom::protocol  ? options.pairs_from
                    : protocol.pairs_from == PairsFrom::reference ? RpePairsFrom::reference
                                                                  : RpePairsFrom::estimate;
  const Trajectory& measured =
      from == RpePairsFrom::reference ? evaluation.reference : evaluation.estimate;
  const std::vector<FromTo> pairs = stretch_pairs(evaluation.reference, measured, rule, stretch);
  return scores({evaluation.reference, evaluation.estimate, pairs, protocol},
                options,
                evaluation.reference.size());
}

}  // namespace loopbench
