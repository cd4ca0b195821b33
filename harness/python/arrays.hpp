/// Conversion between numpy arrays and core types. Poses are rows of 8 numbers, stamp x y z qx qy
/// qz qw [s, m], edges rows of 46, as in harness/sweep/catalogue/message.hpp. A pose without
/// rotation has four zeros, and is left to check(Trajectory).
#pragma once

#include <pybind11/numpy.h>

#include <string>
#include <vector>

#include "datasets/core/problem.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench::python {

using Array = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

struct ReadRows {
  Trajectory poses;
  double off_unit = 0.0;  ///< maximum | |q| - 1 | before normalisation, as of files
};

/// `name` is for messages. Throws InputError for another shape, for values that are not finite and
/// for quaternions that are neither unit nor zero; the order of stamps is left to
/// check(Trajectory). O(n).
ReadRows read_rows(const Array& rows, const std::string& name);

Array rows_of(const Trajectory& poses);

/// Edges of keyframes. Throws InputError for another shape and for an index that is not one; all
/// else is left to check(Problem).
std::vector<Edge> read_edges(const Array& rows, const std::string& name);

Array edge_rows(const std::vector<Edge>& edges);

}  // namespace loopbench::python
