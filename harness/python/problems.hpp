/// Problems of numpy arrays, and their correction.
#pragma once

#include "harness/python/arrays.hpp"

namespace loopbench::python {

/// One trajectory of the arguments of a function. Throws InputError.
Trajectory checked(const Array& rows, const std::string& name);

/// Adds the class Problem, and the functions that make problems or take them.
void add_problems(pybind11::module_& module);

}  // namespace loopbench::python
