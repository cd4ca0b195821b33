#include "metrics/pairing/tum_motions.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_set>

#include "datasets/core/parallel.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/numerics/statistics.hpp"

namespace loopbench::metrics {
namespace {

/// State after init_by_array({0}); mt19937 takes the 32-bit words unchanged.
struct SeedZero {
  using result_type = std::uint32_t;

  template <class Iterator>
  void generate(Iterator begin, Iterator end) {
    const auto size = static_cast<std::uint32_t>(end - begin);
    const auto mixed = [&](std::uint32_t i) {
      const std::uint32_t before = begin[i - 1];
      return before ^ (before >> 30U);
    };
    begin[0] = 19650218U;
    for (std::uint32_t i = 1; i < size; ++i) begin[i] = 1812433253U * mixed(i) + i;
    std::uint32_t i = 1;
    const auto next = [&] {
      if (++i < size) return;
      begin[0] = begin[size - 1];
      i = 1;
    };
    for (std::uint32_t k = 0; k < size; ++k, next()) begin[i] = begin[i] ^ (mixed(i) * 1664525U);
    for (std::uint32_t k = 1; k < size; ++k, next()) {
      begin[i] = (begin[i] ^ (mixed(i) * 1566083941U)) - i;
    }
    begin[0] = 0x80000000U;
  }
};

std::mt19937 seeded() {
  SeedZero zero;
  return std::mt19937(zero);
}

}  // namespace

PythonRandom::PythonRandom() : bits_(seeded()) {}

std::size_t PythonRandom::below(std::size_t size) {
  const auto width = static_cast<unsigned>(std::bit_width(size));
  std::size_t out = size;
  while (out >= size) out = static_cast<std::size_t>(bits_()) >> (32U - width);
  return out;
}

std::vector<std::size_t> PythonRandom::sample(std::size_t size, std::size_t count) {
  // Python's size estimate for a set of `count`; it copies a smaller population instead.
  std::size_t set_size = 21;
  if (count > 5) {
    std::size_t table = 1;
    while (table < 3 * count) table *= 4;
    set_size += table;
  }
  std::vector<std::size_t> out(count);
  if (size <= set_size) {
    std::vector<std::size_t> left(size);
    std::iota(left.begin(), left.end(), std::size_t{0});
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t at = below(size - k);
      out[k] = left[at];
      left[at] = left[size - k - 1];
    }
  } else {
    std::unordered_set<std::size_t> seen;
    for (std::size_t& drawn : out) {
      do {
        drawn = below(size);
      } while (!seen.insert(drawn).second);
    }
  }
  return out;
}

namespace {

double median_step(const std::vector<double>& stamps) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < stamps.size(); ++i) steps.push_back(stamps[i] - stamps[i - 1]);
  if (steps.empty()) return std::numeric_limits<double>::infinity();
  return statistics(std::move(steps)).median;
}

std::vector<double> measure(const Trajectory& estimate, DeltaUnit unit) {
  std::vector<double> out(estimate.size());
  switch (unit) {
    case DeltaUnit::s:
      return stamps(estimate);
    case DeltaUnit::frames:
      std::iota(out.begin(), out.end(), 0.0);
      return out;
    case DeltaUnit::m:
      return accumulated_distances(estimate);
    case DeltaUnit::rad:
    case DeltaUnit::deg:
      break;
  }
  out = rotation_angles(estimate, AngleFormula::trace);
  const double factor = unit == DeltaUnit::deg ? kDegrees : 1.0;
  double sum = 0.0;
  for (double& angle : out) angle = sum += factor * angle;
  return out;
}

/// The pairs of estimate poses without a reference gap, and the poses they use.
TumMotions paired_motions(const Paired& complete,
                          double offset,
                          const Alignment& alignment,
                          const std::vector<FromTo>& pairs) {
  constexpr std::size_t kUnmatched = std::numeric_limits<std::size_t>::max();
  constexpr std::size_t kUnused = kUnmatched - 1;
  const auto& reference = complete.reference;
  const auto& estimate = complete.estimate;
  const std::vector<double> reference_stamps = stamps(reference);
  const double limit = 2.0 * median_step(reference_stamps);
  std::vector<std::size_t> nearest(estimate.size(), kUnused);
  for (const auto& [i, j] : pairs) nearest[i] = nearest[j] = kUnmatched;
  parallel_for_blocks(estimate.size(), [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      if (nearest[i] == kUnused) continue;
      const double stamp = estimate[i].stamp + offset;
      const std::size_t found = tum_closest_index(reference_stamps, stamp);
      if (std::abs(reference_stamps[found] - stamp) <= limit) nearest[i] = found;
    }
  });
  TumMotions out;
  std::vector<std::size_t> paired_index(estimate.size(), kUnmatched);  // index into `out`
  const auto taken = [&](std::size_t i) {
    if (paired_index[i] == kUnmatched) {
      paired_index[i] = out.poses.estimate.size();
      out.poses.estimate.push_back(estimate[i]);
      out.poses.reference.push_back(reference[nearest[i]]);
    }
    return paired_index[i];
  };
  for (const auto& [i, j] : pairs) {
    if (nearest[i] == kUnmatched || nearest[j] == kUnmatched) continue;
    const std::size_t from = taken(i);
    out.pairs.emplace_back(from, taken(j));
  }
  out.poses.estimate = moved(alignment, std::move(out.poses.estimate));
  return out;
}

}  // namespace

std::size_t tum_closest_index(const std::vector<double>& sorted, double wanted) {
  std::size_t begin = 0;
  std::size_t end = sorted.size();
  std::size_t best = 0;
  double difference = std::abs(sorted[0] - wanted);
  while (begin < end) {
    const std::size_t middle = (begin + end) / 2;
    const double here = std::abs(sorted[middle] - wanted);
    if (here < difference) {
      difference = here;
      best = middle;
    }
    if (sorted[middle] == wanted) return middle;
    if (sorted[middle] > wanted) {
      end = middle;
    } else {
      begin = middle + 1;
    }
  }
  return best;
}

TumMotions tum_motions(const Paired& complete,
                       double offset,
                       const Alignment& alignment,
                       const PairDelta& pair_delta,
                       std::size_t max_pairs) {
  const std::vector<double> index = measure(complete.estimate, pair_delta.unit);
  std::vector<std::size_t> ends(index.size());
  parallel_for_blocks(ends.size(), [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) ends[i] = tum_closest_index(index, index[i] + pair_delta.delta);
  });
  std::vector<FromTo> pairs;
  pairs.reserve(ends.size());
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (ends[i] + 1 != ends.size()) pairs.emplace_back(i, ends[i]);
  }
  if (max_pairs != 0 && pairs.size() > max_pairs) {
    std::vector<FromTo> drawn;
    for (const std::size_t k : PythonRandom().sample(pairs.size(), max_pairs)) {
      drawn.push_back(pairs[k]);
    }
    pairs = std::move(drawn);
  }
  return paired_motions(complete, offset, alignment, pairs);
}

TumMotions tum_random_motions(const Paired& complete,
                              double offset,
                              const Alignment& alignment,
                              std::size_t max_pairs) {
  const std::size_t n = complete.estimate.size();
  const bool takes_all = n * n < max_pairs;
  std::vector<FromTo> pairs;
  PythonRandom random;
  for (std::size_t k = 0; k < (takes_all ? n * n : max_pairs); ++k) {
    const std::size_t i = takes_all ? k / n : random.below(n);
    const std::size_t j = takes_all ? k % n : random.below(n);
    pairs.emplace_back(i, j);
  }
  return paired_motions(complete, offset, alignment, pairs);
}

}  // namespace loopbench::metrics
