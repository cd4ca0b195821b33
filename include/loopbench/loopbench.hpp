/// Everything that a program needs to read, evaluate and correct trajectories. In CMake:
/// find_package(loopbench 1 REQUIRED), target_link_libraries(mine PRIVATE loopbench::loopbench);
/// without: c++ -std=c++20 mine.cpp $(pkg-config --cflags --libs loopbench); in a package of
/// colcon: <depend>loopbench</depend>. tests/plugin/embedded is a complete program.
#pragma once

#include "datasets/formats/formats.hpp"
#include "datasets/formats/g2o.hpp"
#include "datasets/trajectory_dataset.hpp"
#include "methods/method.hpp"
#include "metrics/errors/ate.hpp"
#include "metrics/errors/rpe.hpp"
#include "metrics/protocols/protocols.hpp"

namespace loopbench {

using methods::correct;
using methods::find_method;
using metrics::evaluate;

}  // namespace loopbench
