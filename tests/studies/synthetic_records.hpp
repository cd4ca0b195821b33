/// Records with known true effects, to measure error rates of verdicts.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "harness/answers/compare/observations.hpp"
#include "harness/sweep/model/record.hpp"

namespace loopbench::synthetic {

using namespace harness;

/// Draws of the logarithm of an error, with their expectation.
struct Shape {
  std::string name;
  double mean = 0.0;
  double (*draw)(std::mt19937_64&) = nullptr;
  double typical = mean;  ///< pseudo-median: median of the mean of two draws
};

/// normal, uniform, Laplace, Student's t with 3 degrees of freedom, gamma with skewness 1,
/// exponential (skewness 2), lognormal with sigma 0.5 (skewness 1.8) and 1 (skewness 6.2), and half
/// ties with normal effects.
std::vector<Shape> shapes();

/// Distribution of the errors of several methods. Method 0 is the baseline.
struct Truth {
  std::vector<double> effects;  ///< expected logarithm of each method's error
  std::size_t groups = 10;
  std::size_t runs_in_group = 1;      ///< runs of a group share `shared` of their deviation
  double shared = 0.0;                ///< intra-group correlation of the deviations [-]
  double dispersion = 0.3;            ///< standard deviation of a method's logarithm [-]
  std::vector<double> failures = {};  ///< probability that a method fails; empty: never
  bool states_groups = true;          ///< false: records without CellRow::group
  double copies = 0.0;                ///< share of runs repeated with equal content
  bool baseline_is_fixed = false;     ///< no deviation: ratios to it are as skewed as the shape
  /// Effects by sequence, [sequence][method], added to `effects`; the groups are dealt out to them
  /// in turn. Empty: each group is a sequence of its own.
  std::vector<std::vector<double>> sequences = {};
  std::vector<double> dispersions = {};  ///< by sequence, beside `dispersion`; empty: 1
  double diverges = 0.0;        ///< probability that the last method's error is 1e12 times as large
  double hard = 0.0;            ///< share of groups that are hard
  double fails_hard = 0.0;      ///< probability that method 1 fails on each run of a hard group
  bool is_independent = false;  ///< runs of files: those of two methods are no pairs
};

/// One ATE per method and run.
std::vector<Record> records(const Truth& truth, const Shape& shape, std::mt19937_64& bits);

/// The same without records, ten times as fast; only for effects, failures, sequences, dispersions
/// and a fixed baseline.
Observations observations(const Truth& truth, const Shape& shape, std::mt19937_64& bits);

}  // namespace loopbench::synthetic
