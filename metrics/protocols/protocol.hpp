/// How numbers are made, as a value that is printed beside them.
#pragma once

#include <string>

#include "datasets/core/fields.hpp"

namespace loopbench {

/// How reference and estimate are paired in time.
enum class Association {
  nearest,      ///< one-to-one in order, closest differences first, |dt| <= max_diff
  evo,          ///< evo 1.x: nearest for each pose of the shorter list; one may serve twice
  tum,          ///< TUM associate.py: one-to-one, greedy by difference, strict |dt| < max_diff
  ov_eval,      ///< one pass in time, each reference pose used once, strict |dt| < max_diff
  interpolate,  ///< reference interpolated at the estimate's stamps, gaps up to max_gap
  index,        ///< first with first, second with second: equally long lists, stamps unused
};
inline auto choices(Association) {
  return std::array{std::pair{"nearest", Association::nearest},
                    std::pair{"evo", Association::evo},
                    std::pair{"tum", Association::tum},
                    std::pair{"ov_eval", Association::ov_eval},
                    std::pair{"interpolate", Association::interpolate},
                    std::pair{"index", Association::index}};
}

/// What moves the estimate onto the reference before errors are taken.
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

/// When the estimate is judged.
enum class Times {
  keyframes,  ///< at its own keyframes
  dense,      ///< at every reference stamp inside its span, the curve asked between keyframes
};
inline auto choices(Times) {
  return std::array{std::pair{"keyframes", Times::keyframes}, std::pair{"dense", Times::dense}};
}

/// Both trajectories flattened after alignment, as evo does.
enum class Plane { none, xy, xz, yz };
inline auto choices(Plane) {
  return std::array{std::pair{"none", Plane::none},
                    std::pair{"xy", Plane::xy},
                    std::pair{"xz", Plane::xz},
                    std::pair{"yz", Plane::yz}};
}

/// Which pairs a relative error takes, given a stretch.
enum class PairRule {
  all,          ///< every start, with the end nearest to `delta` within the tolerance
  consecutive,  ///< evo's: one stretch after the other
  /// evaluate_rpe.py --fixed_delta: every estimate pose of the file, probing bisection, last left
  /// out; of more than max_pairs that many, as Python draws them
  tum,
  tum_random,  ///< evaluate_rpe.py alone: max_pairs as Python draws them, whatever delta is
};
inline auto choices(PairRule) {
  return std::array{std::pair{"all", PairRule::all},
                    std::pair{"consecutive", PairRule::consecutive},
                    std::pair{"tum", PairRule::tum},
                    std::pair{"tum_random", PairRule::tum_random}};
}
/// These look at all poses of the files, matched or not.
inline bool is_of_whole_files(PairRule rule) {
  return rule == PairRule::tum || rule == PairRule::tum_random;
}

/// Whose path or turning measures a stretch.
enum class PairsFrom { reference, estimate };
inline auto choices(PairsFrom) {
  return std::array{std::pair{"reference", PairsFrom::reference},
                    std::pair{"estimate", PairsFrom::estimate}};
}

/// The relative error E of reference poses Q and estimate poses P. Angles agree in all four, as do
/// the lengths of evo's and kitti's translations; tum's and left's are other numbers.
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

/// How the angle of a relative error is taken; they differ by about 1e-8 rad near zero.
enum class AngleFormula {
  rotation_vector,  ///< length of the logarithm
  trace,            ///< arccos of the clamped (trace - 1) / 2
};
inline auto choices(AngleFormula) {
  return std::array{std::pair{"rotation_vector", AngleFormula::rotation_vector},
                    std::pair{"trace", AngleFormula::trace}};
}

/// Where a sub-trajectory that starts at i ends; d is the reference's accumulated distance.
enum class SegmentEnd {
  nearest,  ///< j >= i with the smallest |d_j - (d_i + length)|, below the tolerance
  rpg,      ///< the same ends, but the k-th end found goes with the k-th pose: rpg as shipped
  beyond,   ///< first j with d_j > d_i + length, no tolerance: KITTI
  eth3d,    ///< ETH3D's walking end as shipped: many early starts are lost; per metre gone
};
inline auto choices(SegmentEnd) {
  return std::array{std::pair{"nearest", SegmentEnd::nearest},
                    std::pair{"rpg", SegmentEnd::rpg},
                    std::pair{"beyond", SegmentEnd::beyond},
                    std::pair{"eth3d", SegmentEnd::eth3d}};
}

/// In what numbers segment errors are computed and summed.
enum class Precision { float64, float32 };
inline auto choices(Precision) {
  return std::array{std::pair{"float64", Precision::float64},
                    std::pair{"float32", Precision::float32}};
}

/// The one number of a distribution that the original quotes.
enum class Statistic { rmse, mean, median };
inline auto choices(Statistic) {
  return std::array{std::pair{"rmse", Statistic::rmse},
                    std::pair{"mean", Statistic::mean},
                    std::pair{"median", Statistic::median}};
}

/// Sub-trajectories by length. Lengths and tolerance are text: see metrics/protocols/lengths.hpp.
struct SegmentRule {
  std::string lengths = "10% 20% 30% 40% 50%";
  std::string tolerance = "20%";
  SegmentEnd end = SegmentEnd::nearest;
  int step = 1;
  int fewest = 1;
  Precision precision = Precision::float64;
  PairsFrom up = PairsFrom::reference;
  friend bool operator==(const SegmentRule&, const SegmentRule&) = default;
};

/// The defaults are the protocol `loopbench`; the others stand in protocols.hpp.
struct Protocol {
  Association association = Association::nearest;
  double max_diff = 0.02;
  double max_gap = 0.1;
  double max_estimate_gap = 2.0;
  double offset = 0.0;
  Align align = Align::se3;
  int align_first = 0;
  Plane project = Plane::none;
  PairRule pairs = PairRule::all;
  int max_pairs = 10'000;
  PairsFrom pairs_from = PairsFrom::reference;
  double tolerance = 0.1;
  int min_pairs = 10;
  ErrorForm form = ErrorForm::evo;
  AngleFormula angle = AngleFormula::rotation_vector;
  SegmentRule segments{};
  int ddof = 0;
  Statistic statistic = Statistic::rmse;
};

template <class Visit>
void fields(Protocol& o, Visit visit) {
  visit("association", o.association, "how keyframes and reference are paired in time");
  visit("max_diff", o.max_diff, "largest time difference of a pair [s]", Between{0.0});
  visit("max_gap", o.max_gap, "largest reference gap to interpolate over [s]", Above{0.0});
  visit("max_estimate_gap",
        o.max_estimate_gap,
        "longest tracking gap that is judged densely, 0 for any [s]",
        Between{0.0});
  visit("offset", o.offset, "added to the estimate's stamps [s]");
  visit("align", o.align, "what moves the estimate onto the reference");
  visit("align_first", o.align_first, "pairs the alignment sees, 0 for all", Between{0.0});
  visit("project", o.project, "plane to flatten onto, after alignment");
  visit("pairs", o.pairs, "which pairs a relative error takes");
  visit("max_pairs", o.max_pairs, "of tum's pairs, more are drawn from; 0 for all", Between{0.0});
  visit("pairs_from", o.pairs_from, "whose path or turning measures a stretch");
  visit("tolerance", o.tolerance, "how far a stretch may miss, as part of it [-]", Between{0.0});
  visit("min_pairs", o.min_pairs, "fewest pairs that give a relative error", Between{1.0});
  visit("form", o.form, "the relative error of two motions");
  visit("angle", o.angle, "how the angle of a relative error is taken");
  visit("segments.lengths", o.segments.lengths, "of sub-trajectories: metres, or % of the path");
  visit("segments.tolerance", o.segments.tolerance, "their miss: metres, or % of the length");
  visit("segments.end", o.segments.end, "where a sub-trajectory ends");
  visit("segments.step", o.segments.step, "starts are so many poses apart", Between{1.0});
  visit("segments.fewest", o.segments.fewest, "lengths with fewer are left out", Between{1.0});
  visit("segments.precision", o.segments.precision, "their arithmetic");
  visit("segments.up", o.segments.up, "whose z is up for their yaw and gravity angles");
  visit("ddof", o.ddof, "std divides by count - ddof", Between{0.0, 1.0});
  visit("statistic", o.statistic, "the one number the original quotes");
}

/// Throws OptionError, naming the field, when settings contradict each other or a length cannot be
/// read. Single fields were checked by `with`.
void check(const Protocol& protocol);

}  // namespace loopbench
