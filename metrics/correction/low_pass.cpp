#include "metrics/correction/low_pass.hpp"

#include <algorithm>
#include <complex>
#include <unsupported/Eigen/FFT>

#include "metrics/pairing/association.hpp"

namespace loopbench::metrics {
namespace {

/// Centred means of values[begin..end), which has no gap, as differences of running sums: both ends
/// of the window only move forward, even where it shrinks.
void average(const Series& series,
             std::size_t begin,
             std::size_t end,
             double window,
             std::vector<Vector3>& out) {
  std::vector<Vector3> sums(end - begin + 1, Vector3::Zero());
  for (std::size_t i = begin; i < end; ++i) {
    sums[i - begin + 1] = sums[i - begin] + series.values[i];
  }
  const double first = series.times[begin];
  const double last = series.times[end - 1];
  std::size_t low = begin;
  std::size_t high = begin;  // one past the window
  for (std::size_t i = begin; i < end; ++i) {
    const double here = series.times[i];
    const double half = std::min({0.5 * window, here - first, last - here}) + kStampRounding;
    while (here - series.times[low] > half) ++low;
    while (high < end && series.times[high] - here <= half) ++high;
    out.push_back((sums[high - begin] - sums[low - begin]) / static_cast<double>(high - low));
  }
}

}  // namespace

Series resample(const Series& series, std::size_t cells) {
  const std::vector<double>& t = series.times;
  const double step = (t.back() - t.front()) / static_cast<double>(cells);
  Series out;
  std::size_t i = 0;
  for (std::size_t k = 0; k < cells; ++k) {
    const double time = t.front() + (static_cast<double>(k) + 0.5) * step;
    while (i + 2 < t.size() && t[i + 1] <= time) ++i;
    const double u = (time - t[i]) / (t[i + 1] - t[i]);
    out.times.push_back(time);
    out.values.push_back(series.values[i] + u * (series.values[i + 1] - series.values[i]));
  }
  return out;
}

std::vector<Vector3> low_pass(const Series& even, double window) {
  const std::size_t n = even.values.size();
  const double span = (even.times.back() - even.times.front()) * static_cast<double>(n) /
                      static_cast<double>(n - 1);
  // Basis function k of the mirrored series has period 2 span / k.
  const double fastest = 2.0 * span / window;
  std::vector<Vector3> out(n);
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> mirrored(2 * n);
  std::vector<std::complex<double>> waves;
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < n; ++i) {
      mirrored[i] = mirrored[2 * n - 1 - i] = even.values[i][axis];
    }
    fft.fwd(waves, mirrored);
    for (std::size_t k = 0; k < 2 * n; ++k) {
      if (static_cast<double>(std::min(k, 2 * n - k)) > fastest) waves[k] = 0.0;
    }
    fft.inv(mirrored, waves);
    for (std::size_t i = 0; i < n; ++i) out[i][axis] = mirrored[i].real();
  }
  return out;
}

std::vector<Vector3> moving_average(const Series& series, double window) {
  std::vector<Vector3> out;
  out.reserve(series.values.size());
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= series.times.size(); ++i) {
    const bool is_end = i == series.times.size();
    if (!is_end && series.times[i] - series.times[i - 1] <= window) continue;
    average(series, begin, i, window, out);
    begin = i;
  }
  return out;
}

}  // namespace loopbench::metrics
