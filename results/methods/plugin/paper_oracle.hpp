/// The article's smoother with access to the reference, which sets the x' at which curves are
/// evaluated, or the family of each window. The article states neither which x' it uses, nor how
/// its curves were selected ("most consistent with the real trajectory"); this quantifies the
/// effect of each.
#pragma once

#include "methods/method.hpp"
#include "methods/smoothers/manifold/dm.hpp"
#include "metrics/protocols/protocol.hpp"

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

}  // namespace loopbench::paper
