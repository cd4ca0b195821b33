#include "datasets/dataset.hpp"
#include "datasets/simulated/simulated.hpp"

namespace loopbench {

std::vector<DatasetEntry> datasets() {
  return {
      dataset<SimulatedOptions>(
          "simulated", "closed-form paths, odometry that errs, closures", load_simulated),
  };
}

}  // namespace loopbench
