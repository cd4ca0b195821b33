#include "metrics/errors/along_cross.hpp"

#include <cmath>

#include "metrics/trajectory/heading.hpp"

namespace loopbench::metrics {
namespace {

constexpr double kUpright = 1e-3;  // sine between T and up below which `cross` is undefined

/// Unit direction of travel of each pose, kept while at rest; before the first move, the first.
std::vector<Vector3> directions(const Trajectory& reference, const AlongCrossOptions& o) {
  const std::vector<Chord> windows = chords(reference, o.window);
  std::vector<Vector3> out(windows.size());
  std::size_t known = 0;  // number of poses with a direction
  for (std::size_t i = 0; i < windows.size(); ++i) {
    if (!windows[i].is_moving(o.rest_speed)) {
      if (known > 0) out[known++] = out[i - 1];
      continue;
    }
    const Vector3 T = windows[i].displacement.normalized();
    while (known <= i) out[known++] = T;
  }
  if (known == 0) {
    throw Undefined("along_cross: the reference never moves faster than " + to_text(o.rest_speed) +
                    " m/s, so it has no direction of travel");
  }
  return out;
}

Score magnitudes(const std::string& axis, std::vector<double> metres, int ddof) {
  if (!metres.empty()) return {"translation", axis, "m", statistics(std::move(metres), ddof)};
  return {"translation", axis, "m", {}, "the reference only moves parallel to `up`"};
}

}  // namespace

std::vector<Score> along_cross(const Evaluation& evaluation, const AlongCrossOptions& options) {
  const std::vector<Vector3> heading = directions(evaluation.reference, options);
  const Vector3 up = Vector3::Unit(static_cast<int>(options.up));
  std::vector<double> along;
  std::vector<double> off_track;
  std::vector<double> cross;
  std::vector<double> vertical;
  for (std::size_t i = 0; i < heading.size(); ++i) {
    const Vector3& T = heading[i];
    const Vector3 e = evaluation.estimate[i].world_from_body.translation -
                      evaluation.reference[i].world_from_body.translation;
    along.push_back(std::abs(e.dot(T)));
    off_track.push_back((e - e.dot(T) * T).norm());
    const Vector3 beside = up.cross(T);
    if (beside.norm() < kUpright) continue;
    const Vector3 N = beside.normalized();
    cross.push_back(std::abs(e.dot(N)));
    vertical.push_back(std::abs(e.dot(T.cross(N))));
  }
  const int ddof = evaluation.protocol.ddof;
  return {magnitudes("along", std::move(along), ddof),
          magnitudes("off_track", std::move(off_track), ddof),
          magnitudes("cross", std::move(cross), ddof),
          magnitudes("vertical", std::move(vertical), ddof)};
}

}  // namespace loopbench::metrics
