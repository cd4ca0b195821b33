/// The article's text, literally: `dm` with further options, and their values.
#pragma once

#include "methods/smoothers/manifold/dm.hpp"

namespace loopbench::methods {

/// Dm with axes and planes to fit in, and torsion as a signal.
class PaperLiteral final : public Smoother {
 public:
  struct Options {
    DmOptions dm = {};
  };
  /// Throws OptionError as Dm does.
  explicit PaperLiteral(const Options& options) : dm_(options.dm) {}

  std::string why_declined(const Problem& problem) const override {
    return dm_.why_declined(problem);
  }
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override {
    return dm_.smooth(problem, report);
  }

 private:
  Dm dm_;
};

template <class Visit>
void fields(PaperLiteral::Options& o, Visit visit) {
  literal_fields(o.dm, visit);
  fields(o.dm, visit);
}

}  // namespace loopbench::methods

namespace loopbench::methods::manifold {

/// The equations y = f(x) and z = q(x, y) alone: in world axes, without guards, pieces not joined,
/// no psi.
inline DmOptions paper_equations(const SegmentRule& thresholds) {
  return {.planar = 4,
          .spatial = 7,
          .segment = thresholds,
          .chord_above = std::nullopt,
          .up = UpDirection::world_z,
          .height_guard = false,
          .frame = Axes::world,
          .guard = false,
          .quadric_cut = 1e-12,  // rounding only: a full-rank system is solved without truncation
          .joint = {.kind = JointKind::none}};
}

/// All that the text describes: the equations, equal second derivatives at joints that pass through
/// the nodes, and psi at the ends of segments.
inline DmOptions paper_text(const SegmentRule& thresholds) {
  DmOptions out = paper_equations(thresholds);
  out.joint.kind = JointKind::quintic_bridge;
  out.psi = PsiUse::boundary_tangent;
  return out;
}

}  // namespace loopbench::methods::manifold
