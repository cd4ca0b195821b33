/// A straight chain with closures of chosen lengths.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "datasets/derive/odometry.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::test {

/// Steps of 1 m along x with a deviation of 2 cm, and closures that measure `metres`.
inline Problem measured_line(std::size_t steps, const std::vector<double>& metres) {
  std::vector<double> x(steps + 1);
  std::iota(x.begin(), x.end(), 0.0);
  Problem out = along_x(x);
  for (Edge& edge : out.odometry) edge.information = isotropic_information(4e-4, 4e-6);
  for (std::size_t k = 0; k < metres.size(); ++k) {
    const std::size_t from = metres.size() - 1 - k;
    out.closures.push_back(
        {from, steps - from, at_x(metres[k]), isotropic_information(4e-4, 4e-6)});
  }
  std::ranges::sort(out.closures, {}, &Edge::to);
  return out;
}

}  // namespace loopbench::test
