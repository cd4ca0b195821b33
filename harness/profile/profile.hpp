/// What methods cost: time, memory, growth with size, and what accuracy that buys.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/model/record.hpp"
#include "harness/tables/listing.hpp"

namespace loopbench {

/// A straight line through points of logarithms: y ~ x^exponent.
struct PowerLaw {
  double exponent = 0.0;
  double error = 0.0;  ///< standard error of the exponent
  double r2 = 0.0;     ///< share of the spread of log y that it explains
};

/// Least squares over all points; nothing with fewer than three, with x or y not above zero, or
/// when the largest x is less than four times the smallest: too short a lever. O(n).
std::optional<PowerLaw> power_law(const std::vector<double>& x, const std::vector<double>& y);

/// For each point whether no other is at least as good in both and better in one; less is better,
/// and a relative difference up to kRelevant (statistics/ranks.hpp) is none. O(n^2).
std::vector<bool> pareto_front(const std::vector<double>& a, const std::vector<double>& b);

/// Every table below marks methods that were shown the reference with "(oracle)", and its notes
/// name sequences whose closures were measured in it.

/// A row per method: wall and CPU time, memory, allocations, iterations. Medians over its cells
/// that ran to their end, largest value for memory.
Listing costs(const std::vector<CellRecord>& cells);

/// A row per phase and count that a method reports of itself: medians over its cells.
Listing reported(const std::vector<CellRecord>& cells);

/// A row per method with cells of three sizes or more: exponent of its time in keyframes. One point
/// per size: the median over the cells of that size.
Listing scaling(const std::vector<CellRecord>& cells);

/// Which score stands for accuracy.
struct Accuracy {
  std::string metric = "ate";  ///< label
  std::string relation = "translation";
  std::string axis = "3d";
  std::string value = "rmse";
};

/// A row per method: geometric means over all sequences of its mean error and median time over
/// repeats, and whether it is on the front of those that have all runs and were not shown the
/// reference. Errors are those of the store's first protocol, dense where there are dense ones.
Listing pareto(const std::vector<CellRecord>& cells,
               const std::vector<Record>& records,
               const Accuracy& accuracy);

}  // namespace loopbench
