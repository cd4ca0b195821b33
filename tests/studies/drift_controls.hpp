/// Simulated chains with known drift, for the gain that motion_drift can reach.
#pragma once

#include <vector>

#include "tests/studies/development_chains.hpp"

namespace loopbench {

struct DriftControl {
  DevelopmentChain chain;          ///< its name is that of the control
  DevelopmentChain without_drift;  ///< the same noise without drift: what exact knowledge leaves
};

/// Drives of 1 km with three and eight closures, 50 seeds of each control:
///   shared drift   2e-4 rad of yaw and 1e-4 rad of pitch per metre on every chain
///   own drift      rates drawn for each chain, normal with these deviations
///   no drift
///   slips          no drift; one edge in a hundred has ten times its stated deviation
/// `gain` multiplies the standard deviations of the default noise of `driving`.
std::vector<DriftControl> drift_controls(double gain);

}  // namespace loopbench
