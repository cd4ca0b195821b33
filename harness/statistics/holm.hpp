/// Correction for multiple tests.
#pragma once

#include <span>
#include <vector>

namespace loopbench::harness {

/// p-values adjusted by Holm's step-down procedure (Scandinavian Journal of Statistics 6, 1979), in
/// input order: rejecting if the adjusted p is below alpha limits the probability of any false
/// rejection to alpha, for any dependence between the tests. O(n log n).
std::vector<double> holm(std::span<const double> p);

}  // namespace loopbench::harness
