/// Evaluation protocol: association, alignment and error definitions, reported with every score.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/fields.hpp"
#include "datasets/core/plane.hpp"

namespace loopbench::metrics {

/// A length as text: "100" or "0.5" in metres, "20%" relative to a whole.
struct Length {
  std::string text;  ///< "100 m" or "20%", for labels
  double value = 0.0;
  bool is_share = false;  ///< value is a fraction: 0.2 for 20%

  double of(double whole) const { return is_share ? value * whole : value; }
};

/// Positive numbers separated by blanks, each optionally with `%` or `m`. Throws OptionError naming
/// `option` for an empty list or anything but positive numbers.
std::vector<Length> lengths(const std::string& option, const std::string& text);

/// One length, which can be zero.
Length tolerance(const std::string& option, const std::string& text);

/// How reference and estimate are paired in time.
enum class Association {
  nearest,      ///< one-to-one in order, smallest differences first, |dt| <= max_diff
  evo,          ///< evo 1.x: nearest for each pose of the shorter list; a pose can be paired twice
  tum,          ///< TUM associate.py: one-to-one, greedy by difference, strict |dt| < max_diff
  interpolate,  ///< reference interpolated at the estimate's stamps, gaps up to max_gap
  interpolate_estimate,  ///< estimate interpolated at the reference's stamps, gaps up to max_gap
  index,                 ///< pairs equal indices of equally long lists; ignores stamps
};
inline auto choices(Association) {
  return std::array{std::pair{"nearest", Association::nearest},
                    std::pair{"evo", Association::evo},
                    std::pair{"tum", Association::tum},
                    std::pair{"interpolate", Association::interpolate},
                    std::pair{"interpolate_estimate", Association::interpolate_estimate},
                    std::pair{"index", Association::index}};
}

/// Whether max_gap limits the pairs, instead of max_diff.
inline bool interpolates(Association how) {
  return how == Association::interpolate || how == Association::interpolate_estimate;
}

/// Alignment of the estimate to the reference before errors are computed.
enum class Align {
  se3,            ///< least squares, rigid
  sim3,           ///< least squares, rigid and scale
  scale,          ///< sim3's scale alone
  posyaw,         ///< least squares, translation and rotation about z
  origin,         ///< the first poses coincide
  posyaw_origin,  ///< the first positions coincide, and the yaw of the first poses
  none,
};
inline auto choices(Align) {
  return std::array{std::pair{"se3", Align::se3},
                    std::pair{"sim3", Align::sim3},
                    std::pair{"scale", Align::scale},
                    std::pair{"posyaw", Align::posyaw},
                    std::pair{"origin", Align::origin},
                    std::pair{"posyaw_origin", Align::posyaw_origin},
                    std::pair{"none", Align::none}};
}

/// Times at which the estimate is evaluated.
enum class Times {
  keyframes,  ///< at its own keyframes
  dense,      ///< at every reference stamp inside its span; the curve interpolates
};
inline auto choices(Times) {
  return std::array{std::pair{"keyframes", Times::keyframes}, std::pair{"dense", Times::dense}};
}

/// Plane onto which both trajectories are projected after alignment, as in evo.
enum class ProjectionPlane { none, xy, xz, yz };
inline auto choices(ProjectionPlane) {
  return std::array{std::pair{"none", ProjectionPlane::none},
                    std::pair{"xy", ProjectionPlane::xy},
                    std::pair{"xz", ProjectionPlane::xz},
                    std::pair{"yz", ProjectionPlane::yz}};
}

/// Selection of the pose pairs of a relative error for a given delta.
enum class PairRule {
  all,          ///< every start, with the end nearest to `delta` within the tolerance
  consecutive,  ///< evo's: each pair starts where the previous one ends
  /// evaluate_rpe.py --fixed_delta: every estimate pose of the file except the last, end found by
  /// bisection; at most max_pairs, drawn as Python does
  tum,
  tum_random,  ///< evaluate_rpe.py alone: max_pairs drawn as Python does, ignores delta
};
inline auto choices(PairRule) {
  return std::array{std::pair{"all", PairRule::all},
                    std::pair{"consecutive", PairRule::consecutive},
                    std::pair{"tum", PairRule::tum},
                    std::pair{"tum_random", PairRule::tum_random}};
}
/// Whether the rule uses all poses of the files, matched or not.
inline bool uses_complete_files(PairRule rule) {
  return rule == PairRule::tum || rule == PairRule::tum_random;
}

/// Trajectory on which path length and rotation of a pair are measured.
enum class PairsFrom { reference, estimate };
inline auto choices(PairsFrom) {
  return std::array{std::pair{"reference", PairsFrom::reference},
                    std::pair{"estimate", PairsFrom::estimate}};
}

/// The relative error E of reference poses Q and estimate poses P. Angles agree in all four forms,
/// as do the translation lengths of evo and kitti; those of tum and left differ.
enum class ErrorForm {
  evo,    ///< (Q_i^-1 Q_j)^-1 (P_i^-1 P_j)
  kitti,  ///< (P_i^-1 P_j)^-1 (Q_i^-1 Q_j)
  tum,    ///< (P_j^-1 P_i)^-1 (Q_j^-1 Q_i)
  left,   ///< (P_i P_j^-1) (Q_i Q_j^-1)^-1, SLAMBench's
};
inline auto choices(ErrorForm) {
  return std::array{std::pair{"evo", ErrorForm::evo},
                    std::pair{"kitti", ErrorForm::kitti},
                    std::pair{"tum", ErrorForm::tum},
                    std::pair{"left", ErrorForm::left}};
}

/// Formula for the rotation angle of a relative error; they differ by about 1e-8 rad near zero.
enum class AngleFormula {
  rotation_vector,  ///< length of the logarithm
  trace,            ///< arccos of the clamped (trace - 1) / 2
};
inline auto choices(AngleFormula) {
  return std::array{std::pair{"rotation_vector", AngleFormula::rotation_vector},
                    std::pair{"trace", AngleFormula::trace}};
}

/// Rule for the end of a sub-trajectory that starts at i; d is the reference's accumulated
/// distance.
enum class SegmentEnd {
  nearest,  ///< j >= i with the smallest |d_j - (d_i + length)|, below the tolerance
  rpg,      ///< the same ends, but the k-th end found is paired with the k-th pose: rpg as released
  beyond,   ///< first j with d_j > d_i + length, no tolerance: KITTI
};
inline auto choices(SegmentEnd) {
  return std::array{std::pair{"nearest", SegmentEnd::nearest},
                    std::pair{"rpg", SegmentEnd::rpg},
                    std::pair{"beyond", SegmentEnd::beyond}};
}

/// Floating-point precision of segment errors and their sums.
enum class Precision { float64, float32 };
inline auto choices(Precision) {
  return std::array{std::pair{"float64", Precision::float64},
                    std::pair{"float32", Precision::float32}};
}

/// Statistic of an error distribution that summaries print.
enum class Statistic { rmse, mean, median, p90, p95, p99 };
inline auto choices(Statistic) {
  return std::array{std::pair{"rmse", Statistic::rmse},
                    std::pair{"mean", Statistic::mean},
                    std::pair{"median", Statistic::median},
                    std::pair{"p90", Statistic::p90},
                    std::pair{"p95", Statistic::p95},
                    std::pair{"p99", Statistic::p99}};
}

/// Sub-trajectories by length. Lengths and tolerance are text, see Length.
struct SegmentErrorRule {
  std::string lengths = "10% 20% 30% 40% 50%";
  std::string tolerance = "20%";
  SegmentEnd end = SegmentEnd::nearest;
  int step = 1;
  int fewest = 1;
  Precision precision = Precision::float64;
  PairsFrom up = PairsFrom::reference;
  friend bool operator==(const SegmentErrorRule&, const SegmentErrorRule&) = default;
};

/// The defaults are the protocol `loopbench`; protocols.hpp lists the others.
struct Protocol {
  Association association = Association::nearest;
  double max_diff = 0.02;
  double max_gap = 0.1;
  double max_estimate_gap = 2.0;
  double offset = 0.0;
  Align align = Align::se3;
  int align_first = 0;
  Planar planar = Planar::automatic;
  ProjectionPlane project = ProjectionPlane::none;
  PairRule pairs = PairRule::all;
  int max_pairs = 10'000;
  PairsFrom pairs_from = PairsFrom::reference;
  double tolerance = 0.1;
  int min_pairs = 10;
  ErrorForm form = ErrorForm::evo;
  AngleFormula angle = AngleFormula::rotation_vector;
  SegmentErrorRule segments{};
  int ddof = 0;
  Statistic statistic = Statistic::rmse;
};

template <class Visit>
void fields(Protocol& o, Visit visit) {
  visit(
      "association",
      o.association,
      "pairing in time; nearest: one-to-one, smallest differences first; evo: nearest, a pose can "
      "be paired twice; tum: greedy by difference, as associate.py; "
      "interpolate: reference interpolated at the estimate's stamps; interpolate_estimate: "
      "estimate "
      "interpolated at the reference's stamps (control points, GNSS); index: equal indices, stamps "
      "ignored");
  visit("max_diff", o.max_diff, "maximum time difference between paired poses [s]", Between{0.0});
  visit("max_gap", o.max_gap, "longest gap to interpolate across [s]", GreaterThan{0.0});
  visit("max_estimate_gap",
        o.max_estimate_gap,
        "longest tracking gap evaluated densely, 0 for no limit [s]",
        Between{0.0});
  visit("offset", o.offset, "time offset added to the estimate's stamps [s]");
  visit("align", o.align, "alignment of the estimate to the reference");
  visit("align_first",
        o.align_first,
        "number of first pairs used for the alignment, 0 for all",
        Between{0.0});
  visit("planar",
        o.planar,
        "alignment of se3 and sim3 in x, y and yaw; auto: if both trajectories are in one plane "
        "within rounding; yes: both are moved to their planes");
  visit("project", o.project, "plane to project onto after alignment");
  visit("pairs", o.pairs, "rule that selects the pose pairs of relative errors");
  visit("max_pairs",
        o.max_pairs,
        "maximum number of tum pairs (random subset), 0 for no limit",
        Between{0.0});
  visit("pairs_from",
        o.pairs_from,
        "trajectory that defines path length and rotation angle of a pair");
  visit("tolerance",
        o.tolerance,
        "relative tolerance of the distance between paired poses [-]",
        Between{0.0});
  visit("min_pairs", o.min_pairs, "minimum number of pairs for a relative error", Between{1.0});
  visit("form",
        o.form,
        "relative error of the reference's motion Q and the estimate's P; evo: Q^-1 P; kitti: P^-1 "
        "Q; tum: as evaluate_rpe.py, both from end to start; left: in world axes, as SLAMBench");
  visit("angle", o.angle, "formula for the rotation angle of a relative error");
  visit("segments.lengths",
        o.segments.lengths,
        "lengths of the sub-trajectories, in metres or % of the path length");
  visit("segments.tolerance",
        o.segments.tolerance,
        "tolerance of these lengths, in metres or % of the length");
  visit(
      "segments.end",
      o.segments.end,
      "end of a sub-trajectory; nearest: pose nearest to its length; rpg: nearest, with the index "
      "error of the released tool; beyond: first pose farther than its length (KITTI)");
  visit("segments.step",
        o.segments.step,
        "poses between the starts of sub-trajectories",
        Between{1.0});
  visit("segments.fewest",
        o.segments.fewest,
        "minimum number of sub-trajectories for a length",
        Between{1.0});
  visit(
      "segments.precision", o.segments.precision, "floating-point precision of the segment errors");
  visit("segments.up", o.segments.up, "trajectory whose z axis is up for yaw and gravity angles");
  visit("ddof", o.ddof, "delta degrees of freedom: std divides by count - ddof", Between{0.0, 1.0});
  visit("statistic", o.statistic, "statistic that summaries print; of tools: the one they report");
}

/// Throws OptionError, naming the field, if fields contradict each other or a length cannot be
/// parsed. `with` checks single fields.
void check(const Protocol& protocol);

}  // namespace loopbench::metrics
