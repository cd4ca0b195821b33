/// The article's readings as methods: literal ones, and oracles of results/methods/plugin, which
/// take axes from the reference or quantify the gain from a leak of it.
#include "harness/sweep/catalogue/plugin.hpp"
#include "paper_literal.hpp"

namespace loopbench::paper {
namespace {

/// Wraps a Smoother constructible from Options and a reference.
template <class T>
methods::MethodEntry oracle(std::string name, std::string summary, typename T::Options defaults) {
  const auto make = [defaults](const Params& given, const Trajectory& reference) -> methods::Stage {
    return std::unique_ptr<const methods::Smoother>(
        std::make_unique<T>(with(defaults, given), reference));
  };
  return {std::move(name),
          methods::Kind::smoother,
          std::move(summary),
          describe(defaults),
          [make](const Params& given) { return make(given, {}); },
          make};
}

}  // namespace
}  // namespace loopbench::paper

using namespace loopbench::paper;

LOOPBENCH_PLUGIN(
    method<PaperLiteral>("paper_literal",
                         "the article's equations alone: world axes, no guards",
                         {paper_equations({})}),
    oracle<PaperOracle>("paper_oracle",
                        "dm with y' = f(x') evaluated at the reference's x'; quantifies a leak",
                        {}),
    oracle<PaperOracle>("paper_oracle_families",
                        "dm with parabola, cubic, sine or rational selected by the reference",
                        {.dm = {.families = "poly2 poly3 sin1 rat02"},
                         .reference_abscissa = false,
                         .reference_families = true}),
    oracle<PaperOracle>(
        "paper_oracle_overwrite",
        "dm without curves, x' of each window overwritten by the reference's; quantifies what "
        "copying alone gives",
        {.reference_abscissa = false, .overwrite = true}),
    oracle<ReferenceAxes>(
        "paper_reference_axes",
        "the article's equations alone in the reference's axes: uses the rotation of an "
        "alignment, not the reference's positions",
        {{.dm = paper_equations({}), .reference_axes = true, .reference_abscissa = false}}),
    oracle<ReferenceAxes>(
        "paper_text",
        "paper_reference_axes with equal second derivatives at joints and psi",
        {{.dm = paper_text({}), .reference_axes = true, .reference_abscissa = false}}))
