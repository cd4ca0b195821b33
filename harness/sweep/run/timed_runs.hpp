/// Runs of a method with their costs.
#pragma once

#include <memory>

#include "datasets/core/curve.hpp"
#include "datasets/core/problem.hpp"
#include "harness/sweep/model/result.hpp"
#include "harness/sweep/model/sweep.hpp"
#include "methods/method.hpp"

namespace loopbench::harness {

/// Runs and measures the method; memory is that of the first run, measured outside the timed part.
/// Every run asks a new process of a program that serves, so that no answer is from its memory.
/// The times of a short first run are replaced by those of another run, because this process is
/// new; its result is kept. Results of these runs that are not bit-identical are noted.
std::unique_ptr<const Curve> timed(CellResult& result,
                                   const methods::Estimator& method,
                                   const Problem& problem,
                                   const Sweep& sweep);

}  // namespace loopbench::harness
