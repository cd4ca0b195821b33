/// The article's text, literally: `dm` with further options, and their values.
#pragma once

#include "results/methods/plugin/paper_oracle.hpp"

namespace loopbench::paper {

/// Options of the article's literal readings. They are not options of `dm`, whose frames follow the
/// path.
template <class Visit>
void literal_fields(methods::DmOptions& o, Visit visit) {
  visit("plane", o.plane, "plane of the planar curve with frame = world");
}

/// Dm with axes and planes to fit in.
class PaperLiteral final : public methods::Smoother {
 public:
  struct Options {
    methods::DmOptions dm = {};
  };
  /// Throws OptionError as Dm does.
  explicit PaperLiteral(const Options& options) : dm_(options.dm) {}

  std::unique_ptr<const Curve> smooth(const Problem& problem,
                                      methods::Report& report) const override {
    return dm_.smooth(problem, report);
  }

 private:
  methods::Dm dm_;
};

template <class Visit>
void fields(PaperLiteral::Options& o, Visit visit) {
  visit("fit_axes",
        o.dm.fit_axes,
        "axes called world: of the estimate's file, or with z along gravity as estimated from "
        "level cameras");
  literal_fields(o.dm, visit);
  fields(o.dm, visit);
}

/// PaperOracle in the axes of the reference. The article does not state its axes; those of its
/// printed curves are the reference's.
class ReferenceAxes final : public PaperOracle {
 public:
  struct Options : PaperOracle::Options {};
  using PaperOracle::PaperOracle;
};

template <class Visit>
void fields(ReferenceAxes::Options& o, Visit visit) {
  literal_fields(o.dm, visit);
  fields(static_cast<PaperOracle::Options&>(o), visit);
}

/// The equations y = f(x) and z = q(x, y) alone: in world axes, without guards, pieces not joined,
/// no psi.
inline methods::DmOptions paper_equations(const methods::manifold::SegmentRule& thresholds) {
  return {.planar = 4,
          .spatial = 7,
          .segment = thresholds,
          .chord_above = std::nullopt,
          .up = methods::manifold::UpDirection::world_z,
          .height_guard = false,
          .frame = methods::manifold::Axes::world,
          .guard = false,
          .quadric_cut = 1e-12,  // rounding only: a full-rank system is solved without truncation
          .joint = {.kind = methods::manifold::JointKind::none}};
}

/// All that the text describes: the equations, equal second derivatives at joints that pass through
/// the nodes, and psi at the ends of segments.
inline methods::DmOptions paper_text(const methods::manifold::SegmentRule& thresholds) {
  methods::DmOptions out = paper_equations(thresholds);
  out.joint.kind = methods::manifold::JointKind::quintic_bridge;
  out.psi = methods::manifold::PsiUse::boundary_tangent;
  return out;
}

}  // namespace loopbench::paper
