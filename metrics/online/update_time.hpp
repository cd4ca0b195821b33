/// Time of the updates of a replay, its growth, and missed deadlines.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

struct UpdateTimeOptions {
  double rate = 10.0;
};

template <class Visit>
void fields(UpdateTimeOptions& o, Visit visit) {
  visit("rate",
        o.rate,
        "rate of updates: one that takes longer than 1 / rate misses its deadline [Hz]",
        GreaterThan{0.0});
}

/// Of the wall times of all updates: `percentile` median, p95, p99 and max [s]; `misses` [%], the
/// share of updates longer than 1 / rate; `growth` [1], the exponent k of the least-squares fit
/// time ~ keyframes^k in logarithms. `growth` is undefined for fewer than three updates, or if the
/// number of keyframes does not at least double. These are measured times: they differ between
/// runs. Needs no reference. Throws Undefined if the method was not replayed or had no update.
/// O(updates log updates).
std::vector<Score> update_time(const Evaluation& evaluation, const UpdateTimeOptions& options);

}  // namespace loopbench::metrics
