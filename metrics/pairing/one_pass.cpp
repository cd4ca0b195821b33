#include <cmath>

#include "metrics/pairing/association.hpp"

namespace loopbench::metrics {

std::vector<IndexPair> match_ov_eval(const std::vector<double>& reference,
                                     const std::vector<double>& estimate,
                                     double max_diff,
                                     double offset) {
  std::vector<IndexPair> out;
  std::size_t next = 0;  // first reference pose not yet passed
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const double wanted = estimate[i] + offset;
    const auto miss = [&] { return std::abs(reference[next] - wanted); };
    while (next < reference.size() && reference[next] < wanted && miss() > max_diff) ++next;
    double best = max_diff;
    bool is_found = false;
    for (; next < reference.size() && miss() < best; ++next) {
      best = miss();
      is_found = true;
    }
    if (is_found) out.push_back({next - 1, i});
  }
  return out;
}

}  // namespace loopbench::metrics
