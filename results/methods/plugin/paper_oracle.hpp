/// The article's smoother with access to the reference, which sets the x' at which curves are
/// evaluated, or the family of each window. The article states neither which x' it uses, nor how
/// its curves were selected ("most consistent with the real trajectory"); this quantifies the
/// effect of each.
#pragma once

#include "datasets/core/polyline.hpp"
#include "methods/method.hpp"
#include "methods/smoothers/manifold/dm.hpp"
#include "metrics/evaluation/evaluation.hpp"
#include "metrics/protocols/protocol.hpp"
#include "results/methods/plugin/reference_abscissa.hpp"

namespace loopbench::paper {

class PaperOracle : public methods::Smoother {
 public:
  struct Options {
    methods::DmOptions dm = {};
    bool reference_axes = false;  ///< fit in axes of the reference, which `dm.plane` exchanges
    bool reference_abscissa = true;
    bool reference_families = false;
    bool overwrite = false;
    metrics::Align reference_align = metrics::Align::se3;
  };

  /// Throws OptionError as Dm does. An empty reference is declined later.
  PaperOracle(const Options& options, Trajectory reference);

  std::string why_declined(const Problem& problem) const override;

  /// The name of what is used is added to the notes. Aligns the keyframes to the reference as a
  /// protocol does, and transforms the reference to their world frame by the inverse. For axes of
  /// the reference, the keyframes are rotated by the alignment, and the curve back. Throws
  /// std::runtime_error without a unique alignment.
  std::unique_ptr<const Curve> smooth(const Problem& problem,
                                      methods::Report& report) const override;

 private:
  std::unique_ptr<const Curve> smooth_in_axes(const Problem& problem,
                                              methods::Report& report) const;

  Options options_;
  methods::Dm dm_;
  Trajectory reference_;
};

template <class Visit>
void fields(PaperOracle::Options& o, Visit visit) {
  visit("reference_abscissa", o.reference_abscissa, "evaluate curves at the reference's x'");
  visit("reference_families",
        o.reference_families,
        "select for each window the one of `families` nearest to the reference");
  visit("reference_align", o.reference_align, "alignment of the reference to the keyframes");
  fields(o.dm, visit);
}

inline metrics::Alignment alignment_of(const Trajectory& keyframes,
                                       const Trajectory& reference,
                                       metrics::Align align) {
  metrics::Protocol protocol;
  protocol.align = align;
  return metrics::evaluate(reference, keyframes, protocol).alignment;
}

/// Transforms the reference to the keyframes' world frame: p = R^T (p_reference - t) / scale.
inline Trajectory aligned_reference(const Trajectory& keyframes,
                                    const Trajectory& reference,
                                    metrics::Align align) {
  const metrics::Alignment to_reference = alignment_of(keyframes, reference, align);
  const Pose estimate_from_reference = to_reference.reference_from_estimate.inverse();
  Trajectory out = reference;
  for (StampedPose& pose : out) {
    pose.world_from_body = estimate_from_reference * pose.world_from_body;
    pose.world_from_body.translation /= to_reference.scale;
  }
  return out;
}

/// Mean squared distance to the reference over the edges of a window [m^2].
inline methods::manifold::PieceCost nearest_to(const Polyline& reference) {
  return [&reference](const methods::manifold::PlanarPiece& piece,
                      const methods::manifold::Window& window,
                      const methods::manifold::Nodes& nodes,
                      const methods::manifold::NodeSpline& spline) {
    constexpr std::size_t parts = 8;  // of an edge
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t edge = window.owned.first; edge < window.owned.last; ++edge) {
      for (std::size_t k = 0; k <= parts; ++k) {
        const double u = static_cast<double>(k) / parts;
        const double time = std::lerp(nodes.stamps[edge], nodes.stamps[edge + 1], u);
        if (!(time >= reference.start() && time <= reference.end())) continue;
        const Vector3 reference_point = reference.at(time).translation - nodes.base;
        sum += (value_of_piece(piece, spline.at(edge, time)) - reference_point).squaredNorm();
        ++count;
      }
    }
    return count > 0.0 ? sum / count : 0.0;  // selects the first family outside the reference
  };
}

/// Planes of the reference's axes are set before Dm fits. Rejects what Dm rejects.
inline methods::DmOptions dm_options(const PaperOracle::Options& options) {
  methods::DmOptions out = options.dm;
  if (options.reference_axes) {
    const methods::Dm checked(options.dm);
    out.plane = methods::manifold::Plane::xoy;
  }
  return out;
}

inline PaperOracle::PaperOracle(const Options& options, Trajectory reference)
    : options_(options), dm_(dm_options(options)), reference_(std::move(reference)) {}

inline std::string PaperOracle::why_declined(const Problem& problem) const {
  if (reference_.empty()) return "an oracle needs a reference";
  return dm_.why_declined(problem);
}

inline std::unique_ptr<const Curve> PaperOracle::smooth(const Problem& problem,
                                                        methods::Report& report) const {
  if (!options_.reference_axes) return smooth_in_axes(problem, report);
  const Rotation axes_from_world =
      methods::manifold::plane_axes(options_.dm.plane) *
      alignment_of(problem.keyframes, reference_, options_.reference_align)
          .reference_from_estimate.rotation;
  auto curve = smooth_in_axes(methods::manifold::in_axes(problem, axes_from_world), report);
  report.notes.push_back("oracle: uses the axes of the reference (rotation of the alignment " +
                         to_text(options_.reference_align) + ")");
  return methods::manifold::in_world(std::move(curve), problem, axes_from_world);
}

inline std::unique_ptr<const Curve> PaperOracle::smooth_in_axes(const Problem& problem,
                                                                methods::Report& report) const {
  if (options_.reference_abscissa || options_.reference_families || options_.overwrite) {
    report.notes.push_back("oracle: uses the reference");
  }
  Polyline reference(aligned_reference(problem.keyframes, reference_, options_.reference_align));
  methods::manifold::PieceCost piece_cost;
  if (options_.reference_families) piece_cost = nearest_to(reference);
  std::shared_ptr<const methods::manifold::ManifoldCurve> fitted =
      dm_.fit(problem, report, piece_cost);
  if (!fitted) return std::make_unique<Polyline>(problem.keyframes);
  ReferenceUse use = options_.reference_abscissa ? ReferenceUse::abscissa : ReferenceUse::none;
  if (options_.overwrite) use = ReferenceUse::overwrite;
  return std::make_unique<ReferenceAbscissa>(std::move(fitted), std::move(reference), use);
}

}  // namespace loopbench::paper
