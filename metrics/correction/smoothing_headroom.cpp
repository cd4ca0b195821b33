#include "metrics/correction/smoothing_headroom.hpp"

#include <algorithm>
#include <bit>
#include <complex>
#include <stdexcept>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "datasets/core/so3.hpp"
#include "metrics/pairing/association.hpp"

namespace loopbench::metrics {
namespace {

/// Values at increasing times.
struct Series {
  std::vector<double> times;  ///< [s]
  std::vector<Vector3> values;
};

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

/// Interpolates linearly and samples at the midpoints of `cells` equal intervals of the time span.
/// Needs at least two times. O(n + cells).
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

/// Ideal low-pass: removes all periods below `window` and keeps the rest, as an orthogonal
/// projection. The series is mirrored at both ends (cosine transform), so a drift causes no
/// discontinuity there. The samples are evenly spaced; their number is a power of two. O(n log n).
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

/// Centred moving average over `window`; it shrinks symmetrically at the ends and next to gaps
/// longer than the window. An oscillation of period T is multiplied by sin(pi window / T) /
/// (pi window / T): 0 at T = window, 64 % at 2 windows and 90 % at 4. O(n).
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

/// Keeps the first pose of repeated stamps (association evo).
Series error_series(const Evaluation& evaluation) {
  Series out;
  for (std::size_t i = 0; i < evaluation.reference.size(); ++i) {
    const auto& [stamp, truth] = evaluation.reference[i];
    if (i > 0 && stamp <= out.times.back()) continue;
    out.times.push_back(stamp);
    out.values.push_back(evaluation.estimate[i].world_from_body.translation - truth.translation);
  }
  return out;
}

Statistics magnitudes(const std::vector<Vector3>& vectors, int ddof) {
  std::vector<double> out;
  out.reserve(vectors.size());
  for (const Vector3& vector : vectors) out.push_back(vector.norm());
  return statistics(std::move(out), ddof);
}

}  // namespace

std::vector<Score> smoothing_headroom(const Evaluation& evaluation,
                                      const SmoothingHeadroomOptions& options) {
  Series errors = error_series(evaluation);
  if (errors.times.size() < 2) {
    throw Undefined("smoothing_headroom: needs two poses with different stamps");
  }
  const int ddof = evaluation.protocol.ddof;
  const bool is_sharp = options.filter == Filter::sharp;
  if (is_sharp) errors = resample(errors, std::bit_ceil(2 * errors.times.size()));
  const Statistics before = magnitudes(errors.values, ddof);
  if (before.rmse == 0.0) {
    throw Undefined("smoothing_headroom: the error is zero");
  }
  const Statistics after = magnitudes(
      is_sharp ? low_pass(errors, options.window) : moving_average(errors, options.window), ddof);
  return descriptions({{"before", "3d", "m", before},
                       {"after", "3d", "m", after},
                       single("gain", "3d", "%", 100.0 * (1.0 - after.rmse / before.rmse))});
}

}  // namespace loopbench::metrics
