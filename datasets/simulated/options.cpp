#include "datasets/simulated/options.hpp"

namespace loopbench {
namespace {

std::string option_identity(const SimulatedOptions& options) {
  return identity_text("simulated", options, [](const std::string&) { return false; });
}

}  // namespace

void check_combination(const SimulatedOptions& o) {
  const SystematicDrift& d = o.drift;
  const std::pair<const char*, double> pitches[] = {{"drift.pitch_per_second", d.pitch_per_second},
                                                    {"drift.pitch_per_metre", d.pitch_per_metre},
                                                    {"drift.pitch_per_radian", d.pitch_per_radian}};
  for (const auto& [name, value] : pitches) {
    if (!o.planar || value == 0.0) continue;
    throw OptionError(name,
                      std::string(name) + " = " + to_text(value) +
                          ": causes motion out of the plane, expected 0 with planar = true");
  }
  if (o.closures.max == 0 && o.closures.false_share > 0.0) {
    throw OptionError(
        "closures.false_share",
        "closures.false_share = " + to_text(o.closures.false_share) +
            ": has no effect without true closures, expected 0 with closures.max = 0");
  }
}

NoiseStream noise_stream(const SimulatedOptions& o) {
  return {o.seed,
          o.stream.empty() ? noise_identity(option_identity(o), {}) : noise_identity(o.stream)};
}

std::string noise_text(const SimulatedOptions& o) {
  const std::string stream = o.stream.empty() ? option_identity(o) : "stream " + o.stream;
  return stream + "; seed " + std::to_string(o.seed);
}

}  // namespace loopbench
