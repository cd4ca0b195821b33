/// A simulated drive with loop closures.
#pragma once

#include "datasets/simulated/simulated.hpp"

namespace loopbench::test {

struct Drive {
  SimulatedPath path = SimulatedPath::driving;
  std::int64_t closures = 20;  ///< true ones
  std::int64_t seed = 1;
  bool planar = true;
  double false_share = 0.0;  ///< false closures / true ones [-]
};

inline Sequence simulated_drive(const Drive& drive) {
  SimulatedOptions options;
  options.path = drive.path;
  options.planar = drive.planar;
  options.seed = drive.seed;
  options.closures.max = drive.closures;
  options.closures.false_share = drive.false_share;
  return load_simulated(options);
}

}  // namespace loopbench::test
