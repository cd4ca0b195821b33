/// The article's smoother where the reference takes part: at which x' it is asked, and which family
/// a window takes. The article says neither whose x it uses nor who chose its curves ("most
/// consistent with the real trajectory"); this shows what either would gain.
#pragma once

#include "methods/method.hpp"
#include "methods/smoothers/manifold/dm.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench {

class PaperOracle final : public Smoother {
 public:
  struct Options {
    DmOptions dm = {};
    bool reference_abscissa = true;
    bool reference_families = false;
    Align reference_align = Align::se3;
  };

  /// Throws OptionError as Dm does. An empty reference is declined later.
  PaperOracle(const Options& options, Trajectory reference);

  std::optional<std::string> declines(const Problem& problem) const override;

  /// The keyframes are aligned to the reference as a protocol would, and the reference brought into
  /// their world by the inverse. Throws std::runtime_error when there is no unique alignment.
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const override;

 private:
  Options options_;
  Dm dm_;
  Trajectory reference_;
};

template <class Visit>
void fields(PaperOracle::Options& o, Visit visit) {
  visit("reference_abscissa", o.reference_abscissa, "curves are asked at the reference's x'");
  visit("reference_families",
        o.reference_families,
        "of `families`, each window takes the one nearest to the reference");
  visit("reference_align", o.reference_align, "how the reference is brought to the keyframes");
  fields(o.dm, visit);
}

}  // namespace loopbench
