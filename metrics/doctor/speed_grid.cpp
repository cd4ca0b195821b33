#include "metrics/doctor/speed_grid.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "metrics/doctor/sampling.hpp"
#include "metrics/numerics/average.hpp"

namespace loopbench::metrics {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

/// What most values are below, with a margin.
double usual_limit(const ArrayXd& values, const ArrayXd& known) {
  constexpr double kMost = 0.95, kMargin = 2.0;
  std::vector<double> sorted;
  for (Index i = 0; i < values.size(); ++i) {
    if (known[i] > 0.0) sorted.push_back(values[i]);
  }
  if (sorted.empty()) return 0.0;
  std::ranges::sort(sorted);
  return kMargin * percentile(sorted, kMost);
}

/// Linear interpolation; quaternions are close to each other.
struct Sampled {
  Eigen::Matrix3Xd positions;
  Eigen::Matrix4Xd rotations;
  ArrayXd known;
  bool has_rotations = true;
};

Sampled sampled_poses(const Trajectory& poses, double begin, double step, Index count, double gap) {
  Sampled out{
      Eigen::Matrix3Xd::Zero(3, count), Eigen::Matrix4Xd::Zero(4, count), ArrayXd::Zero(count)};
  out.has_rotations = !lacks_rotations(poses);
  const auto by_stamp = [](const StampedPose& pose, double stamp) { return pose.stamp < stamp; };
  auto after = poses.begin();
  for (Index k = 0; k < count; ++k) {
    const double stamp = begin + static_cast<double>(k) * step;
    // Neighbours are a step or two ahead, unless the trajectory is dense.
    for (int steps = 0; steps < 8 && after != poses.end() && after->stamp < stamp; ++steps) ++after;
    if (after != poses.end() && after->stamp < stamp)
      after = std::lower_bound(after, poses.end(), stamp, by_stamp);
    if (after == poses.end()) break;
    if (after == poses.begin()) {
      if (after->stamp != stamp) continue;
      ++after;
      if (after == poses.end()) break;
    }
    const StampedPose& a = *(after - 1);
    const StampedPose& b = *after;
    if (b.stamp - a.stamp > gap) continue;
    const double u = (stamp - a.stamp) / (b.stamp - a.stamp);
    out.known[k] = 1.0;
    out.positions.col(k) =
        (1.0 - u) * a.world_from_body.translation + u * b.world_from_body.translation;
    if (!out.has_rotations) continue;
    const Eigen::Vector4d& qa = a.world_from_body.rotation.coeffs();
    const Eigen::Vector4d& qb = b.world_from_body.rotation.coeffs();
    out.rotations.col(k) = (1.0 - u) * qa + (qa.dot(qb) < 0.0 ? -u : u) * qb;
  }
  // Signs of quaternions continue.
  for (Index k = 1; k < count; ++k) {
    if (out.rotations.col(k).dot(out.rotations.col(k - 1)) < 0.0) out.rotations.col(k) *= -1.0;
  }
  return out;
}

/// Sums of kWindowSteps neighbours; one column less for each but the first.
template <class Columns>
Columns window_sums(const Columns& all) {
  const Index count = std::max<Index>(0, all.cols() - kWindowSteps + 1);
  Columns out = Columns::Zero(all.rows(), count);
  if (count == 0) return out;
  for (Index k = 0; k < kWindowSteps; ++k) out += all.middleCols(k, count);
  return out;
}

}  // namespace

GridSignal::GridSignal(const ArrayXd& values, ArrayXd known) : mask(std::move(known)) {
  const double limit = usual_limit(values, mask);
  value = values.min(limit) * mask;
  const double count = mask.sum();
  if (count > 0.0) value = (value - value.sum() / count) * mask;
  square = value.square();
}

GridSignal GridSignal::coarser(Index count) const {
  const Index size = value.size() / count;
  ArrayXd values = ArrayXd::Zero(size), known = ArrayXd::Zero(size);
  for (Index i = 0; i < size; ++i) {
    const double common = mask.segment(i * count, count).sum();
    if (2.0 * common < static_cast<double>(count)) continue;
    known[i] = 1.0;
    values[i] = value.segment(i * count, count).sum() / common;
  }
  GridSignal out = *this;
  out.mask = known;
  out.value = values;
  out.square = values.square();
  return out;
}

Correlated correlation_at(const GridSignal& a, const GridSignal& b, Index lag) {
  const Index begin = std::max<Index>(0, -lag);
  const Index end = std::min(b.value.size(), a.value.size() - lag);
  if (end <= begin) return {};
  const Index count = end - begin;
  const auto of_a = [&](const ArrayXd& all) { return all.segment(begin + lag, count).matrix(); };
  const auto of_b = [&](const ArrayXd& all) { return all.segment(begin, count).matrix(); };
  Correlated out;
  out.points = of_a(a.mask).dot(of_b(b.mask));
  if (out.points < 2.0) return out;
  const double sum_a = of_a(a.value).dot(of_b(b.mask)), sum_b = of_a(a.mask).dot(of_b(b.value));
  const double squares_a = of_a(a.square).dot(of_b(b.mask)) - sum_a * sum_a / out.points;
  const double squares_b = of_a(a.mask).dot(of_b(b.square)) - sum_b * sum_b / out.points;
  const double product = of_a(a.value).dot(of_b(b.value)) - sum_a * sum_b / out.points;
  constexpr double kRounding = 1e-12;  // of constants
  const double least_a = kRounding * a.square.sum(), least_b = kRounding * b.square.sum();
  if (squares_a > least_a && squares_b > least_b)
    out.value = product / std::sqrt(squares_a * squares_b);
  return out;
}

double correlated_points(const GridSignal& a, const GridSignal& b) {
  const Index most = std::min(a.value.size(), b.value.size()) / 3;
  double out = 1.0;
  for (Index lag = 1; lag < most; ++lag) {
    out += 2.0 * correlation_at(a, a, lag).value * correlation_at(b, b, lag).value;
  }
  return std::max(1.0, out);
}

SpeedGrid speed_grid(const Trajectory& poses, double step, double max_gap) {
  const double begin = poses.front().stamp;
  const auto count = static_cast<Index>((poses.back().stamp - begin) / step) + 1;
  const Sampled all = sampled_poses(poses, begin, step, count, max_gap);
  const Eigen::Matrix3Xd positions = window_sums(all.positions);
  const Eigen::Matrix4Xd rotations = window_sums(all.rotations);
  const Eigen::RowVectorXd known = window_sums(Eigen::RowVectorXd(all.known.matrix()));
  const Index size = std::max<Index>(0, known.size() - kWindowSteps);
  ArrayXd distance = ArrayXd::Zero(size), angle = distance, mask = distance;
  const double window = static_cast<double>(kWindowSteps) * step;
  for (Index k = 0; k < size; ++k) {
    const double all_known = kWindowSteps;
    if (known[k] < all_known || known[k + kWindowSteps] < all_known) continue;
    mask[k] = 1.0;
    distance[k] = (positions.col(k + kWindowSteps) - positions.col(k)).norm() /
                  (static_cast<double>(kWindowSteps) * window);
    const double cosine =
        std::abs(rotations.col(k).normalized().dot(rotations.col(k + kWindowSteps).normalized()));
    angle[k] = 2.0 * std::acos(std::min(1.0, cosine)) / window;
  }
  const ArrayXd rotates = all.has_rotations ? mask : ArrayXd(ArrayXd::Zero(size));
  return {begin + window - 0.5 * step, step, {distance, mask}, {angle, rotates}};
}

}  // namespace loopbench::metrics
