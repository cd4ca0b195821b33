/// Everything that a program needs to read, evaluate and correct trajectories.
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
