/// The article's smoother in the axes of the reference. The article does not state its axes; those
/// of its printed curves are the reference's.
#pragma once

#include "paper_literal.hpp"
#include "results/methods/plugin/paper_oracle.hpp"

namespace loopbench::paper {

class ReferenceAxes final : public methods::Smoother {
 public:
  struct Options : PaperOracle::Options {};

  /// Throws OptionError as Dm does. An empty reference is declined later.
  ReferenceAxes(const Options& options, Trajectory reference);

  std::string why_declined(const Problem& problem) const override {
    return oracle_.why_declined(problem);
  }

  /// Rotates the keyframes to the reference's axes by the rotation of `reference_align`, without
  /// the reference's positions, and the curve back; the notes say so. Throws std::runtime_error
  /// without a unique alignment.
  std::unique_ptr<const Curve> smooth(const Problem& problem,
                                      methods::Report& report) const override;

 private:
  methods::manifold::Plane plane_;
  metrics::Align align_;
  PaperOracle oracle_;  ///< in axes that are already set
  Trajectory reference_;
};

template <class Visit>
void fields(ReferenceAxes::Options& o, Visit visit) {
  literal_fields(o.dm, visit);
  fields(static_cast<PaperOracle::Options&>(o), visit);
}

}  // namespace loopbench::paper
