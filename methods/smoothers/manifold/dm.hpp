/// The article's smoother, "Loop Closure Detection Based on Differentiable Manifold".
///
/// Despite its title it does not detect loops. It splits a keyframe trajectory where speed or
/// direction changes. On windows of N (planar) or M (spatial) nodes it replaces y' by a curve f(x')
/// and z' by a surface q(x', y'). Orientation is not changed. The defaults are a robust
/// interpretation of the article; the literal interpretation is a set of options (methods.cpp,
/// paper_literal_*). The abscissa is always that of the estimate, because a method has no access to
/// the reference.
#pragma once

#include "methods/method.hpp"
#include "methods/smoothers/manifold/curve.hpp"
#include "methods/smoothers/manifold/dm_options.hpp"

namespace loopbench::methods {

class Dm final : public Smoother {
 public:
  using Options = DmOptions;

  /// Throws OptionError for contradictory options or an unknown family.
  explicit Dm(const Options& options);

  /// Smooths the keyframes. O(keyframes log frames). Counts: nodes, quasi_keyframes, gaps_left,
  /// segments and, if the stage is enabled, windows, split_windows, fallbacks, refused_families,
  /// mean_window_nodes, spatial_windows, spatial_truncated, spatial_fallbacks; and the largest
  /// jumps at nodes (see Continuity). Fewer than three nodes give the polyline. Segments separated
  /// by intervals above `chord_above`, or short ones (pose_runs.hpp), are smoothed separately and
  /// joined by chords (smooth_segments()).
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override;

  /// Returns the same curve as pieces, or null for fewer than three nodes, in the axes of `problem`
  /// for any `fit_axes` and `plane`. `piece_cost`, if set, selects the family instead of
  /// `selection`.
  std::unique_ptr<const manifold::ManifoldCurve> fit(const Problem& problem,
                                                     Report& report,
                                                     const manifold::PieceCost& piece_cost) const;

 private:
  std::unique_ptr<const Curve> smooth_in_axes(const Problem& problem, Report& report) const;
  std::unique_ptr<const manifold::ManifoldCurve> fit(const Problem& problem,
                                                     manifold::NodesWithQuasiKeyframes dense,
                                                     Report& report,
                                                     const manifold::PieceCost& piece_cost) const;

  Options options_;
  std::vector<manifold::Family> families_;
};

}  // namespace loopbench::methods
