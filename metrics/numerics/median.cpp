#include "metrics/numerics/median.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "datasets/core/parallel.hpp"

namespace loopbench::metrics {
namespace {

constexpr std::size_t kMedianSample = 4096;

/// Two values that very likely enclose the median: those 5 sigma of the sample's rank around its
/// median.
std::pair<double, double> middle_bracket(std::span<const double> values) {
  constexpr std::size_t kMargin = 160;
  std::vector<double> sample(kMedianSample);
  for (std::size_t k = 0; k < kMedianSample; ++k)
    sample[k] = values[values.size() * k / kMedianSample];
  const auto at = [&](std::size_t rank) {
    return sample.begin() + static_cast<std::ptrdiff_t>(rank);
  };
  std::nth_element(sample.begin(), at(kMedianSample / 2 - kMargin), sample.end());
  const double low = *at(kMedianSample / 2 - kMargin);
  std::nth_element(at(kMedianSample / 2 - kMargin), at(kMedianSample / 2 + kMargin), sample.end());
  return {low, *at(kMedianSample / 2 + kMargin)};
}

/// The values from low to high, and the number of values below.
struct NearMiddle {
  std::size_t below = 0;
  std::vector<double> values;
};

NearMiddle near_middle(std::span<const double> values, double low, double high) {
  constexpr std::size_t kBlock = 1024;
  NearMiddle out;
  std::vector<double> kept(kBlock);
  for (std::size_t begin = 0; begin < values.size(); begin += kBlock) {
    std::size_t below = 0;
    std::size_t count = 0;
    // Branch-free (& instead of &&): always writes and advances only if kept, since the branches
    // are unpredictable.
    for (const double value : values.subspan(begin, std::min(kBlock, values.size() - begin))) {
      below += value < low ? 1 : 0;
      kept[count] = value;
      count += static_cast<std::size_t>(low <= value) & static_cast<std::size_t>(value <= high);
    }
    out.below += below;
    out.values.insert(
        out.values.end(), kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(count));
  }
  return out;
}

/// Multi-threaded variant.
NearMiddle near_middle_in_parts(std::span<const double> values, double low, double high) {
  const std::size_t count = values.size() < 2 * kMinItemsPerThread ? 1 : hardware_threads();
  std::vector<NearMiddle> parts(count);
  parallel_invoke(count, [&](std::size_t k) {
    const std::size_t begin = values.size() * k / count;
    const std::size_t end = values.size() * (k + 1) / count;
    parts[k] = near_middle(values.subspan(begin, end - begin), low, high);
  });
  NearMiddle out = std::move(parts.front());
  for (std::size_t k = 1; k < count; ++k) {
    out.below += parts[k].below;
    out.values.insert(out.values.end(), parts[k].values.begin(), parts[k].values.end());
  }
  return out;
}

}  // namespace

double median(std::span<const double> values) {
  const std::size_t lower = (values.size() - 1) / 2;
  const std::size_t upper = values.size() / 2;
  NearMiddle middle;
  if (values.size() > kMedianSample) {
    const auto [low, high] = middle_bracket(values);
    middle = near_middle_in_parts(values, low, high);
  }
  if (lower < middle.below || upper >= middle.below + middle.values.size()) {
    middle = {0, {values.begin(), values.end()}};  // few values, or an unrepresentative sample
  }
  const auto at = middle.values.begin() + static_cast<std::ptrdiff_t>(lower - middle.below);
  std::nth_element(middle.values.begin(), at, middle.values.end());
  if (values.size() % 2 == 1) return *at;
  return 0.5 * (*at + *std::min_element(at + 1, middle.values.end()));
}

}  // namespace loopbench::metrics
