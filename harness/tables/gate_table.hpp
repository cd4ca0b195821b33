/// Reports of the gate as text.
#pragma once

#include <string>

#include "harness/compare/gate.hpp"

namespace loopbench::harness {

/// Verdict and table of findings.
std::string markdown(const GateReport& report, const std::string& sweep);

/// JUnit test suite with one case per cell of the baseline, failed if it has a regression, and one
/// for each regression over all runs. Escaped for XML 1.0.
std::string junit(const GateReport& report, const std::string& sweep);

}  // namespace loopbench::harness
