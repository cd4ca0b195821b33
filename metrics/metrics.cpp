#include "metrics/metric.hpp"

namespace loopbench {

std::vector<MetricEntry> metrics() { return {}; }

}  // namespace loopbench
