#include "metrics/pairing/pairs/consecutive.hpp"

namespace loopbench::metrics {

std::vector<FromTo> consecutive_frames(std::size_t size, std::size_t delta) {
  std::vector<FromTo> out;
  for (std::size_t i = 0; i + delta < size; i += delta) out.emplace_back(i, i + delta);
  return out;
}

std::vector<FromTo> consecutive_by_measure(const std::vector<double>& steps,
                                           double delta,
                                           FirstPose first) {
  std::vector<FromTo> out;
  bool has_start = first == FirstPose::starts;
  std::size_t start = 0;
  double gone = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    gone += steps[i];
    if (gone < delta) continue;
    if (has_start) out.emplace_back(start, i);
    has_start = true;
    start = i;
    gone = 0.0;
  }
  return out;
}

std::vector<FromTo> consecutive_seconds(const std::vector<double>& stamps,
                                        double delta,
                                        double tolerance) {
  std::vector<FromTo> out;
  std::size_t start = 0;
  for (const FromTo& pair : pairs_by_measure(stamps, delta, tolerance)) {
    if (pair.first < start) continue;
    out.push_back(pair);
    start = pair.second;
  }
  return out;
}

}  // namespace loopbench::metrics
