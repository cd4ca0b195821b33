#include "reference_axes.hpp"

#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::paper {
namespace {

/// Rejects what Dm rejects.
PaperOracle::Options in_given_axes(PaperOracle::Options options) {
  const methods::Dm checked(options.dm);
  options.dm.plane = methods::manifold::Plane::xoy;
  return options;
}

}  // namespace

ReferenceAxes::ReferenceAxes(const Options& options, Trajectory reference)
    : plane_(options.dm.plane),
      align_(options.reference_align),
      oracle_(in_given_axes(options), reference),
      reference_(std::move(reference)) {}

std::unique_ptr<const Curve> ReferenceAxes::smooth(const Problem& problem,
                                                   methods::Report& report) const {
  metrics::Protocol protocol;
  protocol.align = align_;
  const Rotation axes_from_world = methods::manifold::plane_axes(plane_) *
                                   metrics::evaluate(reference_, problem.keyframes, protocol)
                                       .alignment.reference_from_estimate.rotation;
  auto curve = oracle_.smooth(methods::manifold::in_axes(problem, axes_from_world), report);
  report.notes.push_back("oracle: uses the axes of the reference (rotation of the alignment " +
                         to_text(align_) + ")");
  return methods::manifold::in_world(std::move(curve), problem, axes_from_world);
}

}  // namespace loopbench::paper
