#include "datasets/dataset.hpp"

namespace loopbench {

std::vector<DatasetEntry> datasets() { return {}; }

}  // namespace loopbench
