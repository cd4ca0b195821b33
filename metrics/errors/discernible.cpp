#include "metrics/errors/discernible.hpp"

#include <algorithm>

#include "metrics/numerics/angle.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::metrics {
namespace {

constexpr int kRounds = 100;
constexpr double kConverged = 1e-12;  // of the size of the data

/// Point with the smallest sum of distances, from a start (Weiszfeld). A point at distance zero has
/// the weight of a distance `smallest`.
Vector3 geometric_median(const std::vector<Vector3>& points, double smallest) {
  Vector3 out = Vector3::Zero();
  for (const Vector3& point : points) out += point / static_cast<double>(points.size());
  for (int round = 0; round < kRounds; ++round) {
    Vector3 sum = Vector3::Zero();
    double weights = 0.0;
    for (const Vector3& point : points) {
      const double weight = 1.0 / std::max((point - out).norm(), smallest);
      sum += weight * point;
      weights += weight;
    }
    const Vector3 last = std::exchange(out, sum / weights);
    if ((out - last).norm() <= smallest) break;
  }
  return out;
}

/// Rotation with the smallest sum of angles to the others, from the one that has the smallest sum
/// to a sample of them.
Rotation geodesic_median(const std::vector<Rotation>& rotations) {
  constexpr std::size_t kSample = 50;
  const std::size_t step = (rotations.size() + kSample - 1) / kSample;
  Rotation out = rotations.front();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < rotations.size(); i += step) {
    double sum = 0.0;
    for (std::size_t k = 0; k < rotations.size(); k += step) {
      sum += angle_between(rotations[i], rotations[k]);
    }
    if (sum < least) out = rotations[i];
    least = std::min(sum, least);
  }
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Vector3> tangents;
    for (const Rotation& rotation : rotations) {
      tangents.push_back(log_so3(rotation * out.conjugate()));
    }
    Vector3 sum = Vector3::Zero();
    double weights = 0.0;
    for (const Vector3& tangent : tangents) {
      const double weight = 1.0 / std::max(tangent.norm(), kConverged);
      sum += weight * tangent;
      weights += weight;
    }
    out = (exp_so3(sum / weights) * out).normalized();
    if ((sum / weights).norm() <= kConverged) break;
  }
  return out;
}

/// Positions relative to their geometric median, and the median distance to it.
struct Centred {
  std::vector<Vector3> positions;
  double size = 0.0;
};

Centred centred(const Trajectory& poses) {
  Centred out;
  Vector3 low = poses.front().world_from_body.translation, high = low;
  for (const auto& [stamp, pose] : poses) {
    out.positions.push_back(pose.translation);
    low = low.cwiseMin(pose.translation);
    high = high.cwiseMax(pose.translation);
  }
  const double smallest = std::max(kConverged * (high - low).norm(), 1e-300);
  const Vector3 middle = geometric_median(out.positions, smallest);
  std::vector<double> distances;
  for (Vector3& position : out.positions) {
    position -= middle;
    distances.push_back(position.norm());
  }
  out.size = median(distances);
  return out;
}

double mean_and_rmse(std::vector<double> errors) {
  const Statistics s = statistics(std::move(errors));
  return 0.5 * (s.mean + s.rmse);
}

}  // namespace

std::vector<Score> discernible(const Evaluation& evaluation, const DiscernibleOptions& options) {
  if (const std::string why = why_no_attitude(evaluation); !why.empty()) throw Undefined(why);
  const Centred reference = centred(evaluation.reference);
  const Centred estimate = centred(evaluation.estimate);
  if (!(reference.size > 0.0) || !(estimate.size > 0.0)) {
    throw Undefined("discernible: half of the positions coincide");
  }
  std::vector<Rotation> relative;
  for (std::size_t i = 0; i < evaluation.reference.size(); ++i) {
    relative.push_back(evaluation.reference[i].world_from_body.rotation *
                       evaluation.estimate[i].world_from_body.rotation.conjugate());
  }
  const Rotation rotation = geodesic_median(relative);
  const double scale = reference.size / estimate.size;
  const double cut = options.cut * reference.size;
  std::vector<double> distances, degrees;
  for (std::size_t i = 0; i < relative.size(); ++i) {
    const Vector3 moved = scale * (rotation * estimate.positions[i]);
    distances.push_back(std::min(cut, (moved - reference.positions[i]).norm()) / cut);
    degrees.push_back(kDegrees * angle_between(relative[i], rotation));
  }
  std::vector<Score> out{single("dte", "", "1", mean_and_rmse(std::move(distances))),
                         single("dre", "", "deg", mean_and_rmse(std::move(degrees)))};
  for (Score& score : out) score.statistics.count = relative.size();
  return out;
}

}  // namespace loopbench::metrics
