/// Building blocks of the manifold smoother for Python.
#pragma once

#include <pybind11/pybind11.h>

namespace loopbench::python {

/// Adds the class KeyframePath and the functions of loopbench/manifold.py.
void add_manifold(pybind11::module_& module);

}  // namespace loopbench::python
