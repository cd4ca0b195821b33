#include "harness/oracle/oracle.hpp"
#include "harness/oracle/paper_oracle.hpp"

namespace loopbench::harness {
namespace {

/// Wraps a Smoother constructible from Options and a reference.
template <class T>
OracleEntry oracle(std::string name, std::string summary, typename T::Options defaults) {
  const auto make = [defaults](const Params& given, const Trajectory& reference) -> methods::Stage {
    return std::unique_ptr<const methods::Smoother>(
        std::make_unique<T>(with(defaults, given), reference));
  };
  return {{std::move(name),
           methods::Kind::smoother,
           std::move(summary),
           describe(defaults),
           [make](const Params& given) { return make(given, {}); }},
          make};
}

}  // namespace

std::vector<OracleEntry> oracles() {
  return {
      oracle<PaperOracle>("paper_oracle",
                          "dm with y' = f(x') evaluated at the reference's x'; quantifies a leak",
                          {}),
      oracle<PaperOracle>("paper_oracle_families",
                          "dm with parabola, cubic, sine or rational selected by the reference",
                          {.dm = {.families = "poly2 poly3 sin1 rat02"},
                           .reference_abscissa = false,
                           .reference_families = true}),
  };
}

}  // namespace loopbench::harness
