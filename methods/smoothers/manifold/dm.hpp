/// The paper's smoother, "Loop Closure Detection Based on Differentiable Manifold".
///
/// Despite that title it detects no loops: it takes a keyframe trajectory as it is, cuts it where
/// speed or direction change, and between N (planar) or M (spatial) nodes at a time replaces y'
/// by a curve f(x') and z' by a surface q(x', y'). Orientation passes through. The defaults are
/// its robust reading; the article's letter is a set of options (methods.cpp, paper_literal_*).
/// The abscissa is always the estimate's: a method never sees the reference.
#pragma once

#include "methods/method.hpp"
#include "methods/smoothers/manifold/curve.hpp"
#include "methods/smoothers/manifold/dm_options.hpp"

namespace loopbench {

class Dm final : public Smoother {
 public:
  using Options = DmOptions;

  /// Throws OptionError for options that contradict each other or an unknown family.
  explicit Dm(const Options& options);

  std::optional<std::string> declines(const Problem& problem) const override;

  /// O(keyframes log frames). Counts nodes, quasi_keyframes, gaps_left, segments and, when the
  /// stage is on, windows, split_windows, fallbacks, refused_families, mean_window_nodes,
  /// spatial_windows, spatial_truncated, spatial_fallbacks; then the largest jumps at nodes (see
  /// Continuity). Fewer than three nodes give the polyline. Stretches between intervals above
  /// `chord_above` are smoothed apart and joined by chords: smoothed_apart().
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override;

  /// The same as its pieces, or null for fewer than three nodes. `judge`, when there is one,
  /// chooses between the families in the place of `selection`.
  std::unique_ptr<const manifold::ManifoldCurve> fit(const Problem& problem,
                                                     Report& report,
                                                     const manifold::PieceJudge& judge) const;

 private:
  std::unique_ptr<const Curve> smooth(const Problem& problem,
                                      manifold::Densified dense,
                                      Report& report) const;
  std::unique_ptr<const manifold::ManifoldCurve> fit(const Problem& problem,
                                                     manifold::Densified dense,
                                                     Report& report,
                                                     const manifold::PieceJudge& judge) const;

  Options options_;
  std::vector<manifold::Family> families_;
};

}  // namespace loopbench
