/// Many tests, one error rate.
#pragma once

#include <span>
#include <vector>

namespace loopbench {

/// p-values adjusted by Holm's step-down procedure (Scandinavian Journal of Statistics 6, 1979), in
/// the order given: rejecting where the adjusted p is below alpha keeps the chance of any false
/// rejection below alpha, whatever the dependence between the tests. O(n log n).
std::vector<double> holm(std::span<const double> p);

}  // namespace loopbench
