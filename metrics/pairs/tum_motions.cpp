#include "metrics/pairs/tum_motions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "metrics/angle.hpp"
#include "metrics/pairs/python_random.hpp"
#include "metrics/statistics.hpp"

namespace loopbench {
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
  out = turns(estimate, AngleFormula::trace);
  const double factor = unit == DeltaUnit::deg ? kDegrees : 1.0;
  double sum = 0.0;
  for (double& angle : out) angle = sum += factor * angle;
  return out;
}

/// Poses as TumMotions wants them; for each whether its reference is near enough in time.
std::vector<bool> lay_side_by_side(const Paired& whole,
                                   double offset,
                                   const Alignment& alignment,
                                   Paired& poses) {
  const auto& [reference, estimate] = whole;
  const std::vector<double> reference_stamps = stamps(reference);
  const double limit = 2.0 * median_step(reference_stamps);
  poses.estimate = moved(alignment, estimate);
  std::vector<bool> is_near;
  for (const auto& [stamp, pose] : estimate) {
    const std::size_t nearest = tum_closest_index(reference_stamps, stamp + offset);
    poses.reference.push_back(reference[nearest]);
    is_near.push_back(std::abs(reference_stamps[nearest] - (stamp + offset)) <= limit);
  }
  return is_near;
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

TumMotions tum_motions(const Paired& whole,
                       double offset,
                       const Alignment& alignment,
                       const Stretch& stretch) {
  TumMotions out;
  const std::vector<bool> is_near = lay_side_by_side(whole, offset, alignment, out.poses);
  const std::vector<double> index = measure(whole.estimate, stretch.unit);
  for (std::size_t i = 0; i < index.size(); ++i) {
    const std::size_t j = tum_closest_index(index, index[i] + stretch.delta);
    if (j + 1 != index.size() && is_near[i] && is_near[j]) out.pairs.emplace_back(i, j);
  }
  return out;
}

TumMotions tum_random_motions(const Paired& whole, double offset, const Alignment& alignment) {
  constexpr std::size_t kMostPairs = 10'000;
  TumMotions out;
  const std::vector<bool> is_near = lay_side_by_side(whole, offset, alignment, out.poses);
  const std::size_t n = is_near.size();
  const bool takes_all = n * n < kMostPairs;
  PythonRandom random;
  for (std::size_t k = 0; k < (takes_all ? n * n : kMostPairs); ++k) {
    const std::size_t i = takes_all ? k / n : random.below(n);
    const std::size_t j = takes_all ? k % n : random.below(n);
    if (is_near[i] && is_near[j]) out.pairs.emplace_back(i, j);
  }
  return out;
}

}  // namespace loopbench
