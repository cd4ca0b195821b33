/// One unit of evaluation: a problem, the answer the judge holds, and where each came from.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

struct Provenance {
  std::string sensor;                         ///< "RGB-D", "stereo", "simulated"; empty: unknown
  std::string closures;                       ///< where the loop closures were taken from
  bool oracle_closures = false;               ///< the closures were measured in the reference
  std::string licence;                        ///< of the data; empty: unknown
  std::vector<std::filesystem::path> inputs;  ///< every file read
};

struct Sequence {
  std::string name;
  Problem problem;
  Trajectory reference;  ///< may be empty: then nothing can be judged against it
  Provenance provenance;
};

}  // namespace loopbench
