/// Cost of methods: time, memory, scaling with size, and accuracy against time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/compare/compare.hpp"
#include "harness/model/record.hpp"
#include "harness/tables/table_view.hpp"

namespace loopbench::harness {

/// Least-squares line in log-log coordinates: y ~ x^exponent.
struct PowerLaw {
  double exponent = 0.0;
  double error = 0.0;  ///< standard error of the exponent
  double r2 = 0.0;     ///< coefficient of determination of log y
};

/// Least squares over all points; nullopt with fewer than three, with x or y not above zero, or if
/// the largest x is less than four times the smallest. O(n).
std::optional<PowerLaw> power_law(const std::vector<double>& x, const std::vector<double>& y);

/// For each point, whether it is Pareto-optimal: no other is at least as good in both and better in
/// one. Less is better; relative differences up to kRelevant (statistics/ranks.hpp) are ignored.
/// O(n^2).
std::vector<bool> pareto_front(const std::vector<double>& a, const std::vector<double>& b);

/// Tables of times are empty, with a note, for results of files (`eval --store`).
/// Every table below marks methods that use the reference with "(oracle)", and its notes name
/// sequences whose closures were measured in the reference.

/// One row per method: wall and CPU time, memory, allocations, iterations. Medians over its
/// finished cells, maximum for memory.
TableView costs(const std::vector<CellRecord>& cells);

/// One row per phase and count that a method reports: medians over its cells.
TableView reported(const std::vector<CellRecord>& cells);

/// One row per method with cells of three sizes or more: exponent of its time in the number of
/// keyframes. One point per size: the median over the cells of that size.
TableView scaling(const std::vector<CellRecord>& cells);

/// The score used as accuracy.
struct Accuracy {
  std::string metric = "ate";  ///< label
  std::string relation = "translation";
  std::string axis = "3d";
  std::string value = "rmse";
};

/// One row per method: geometric means over all sequences of its mean error and median time over
/// repeats, and whether it is on the Pareto front of methods that have all runs and do not use the
/// reference. Errors are those of the store's first protocol, dense if available.
TableView pareto(const std::vector<CellRecord>& cells,
                 const std::vector<Record>& records,
                 const Accuracy& accuracy);

/// The same, with records that are visited twice and need not be in memory at once.
TableView pareto(const std::vector<CellRecord>& cells,
                 const RecordSource& records,
                 const Accuracy& accuracy);

}  // namespace loopbench::harness
