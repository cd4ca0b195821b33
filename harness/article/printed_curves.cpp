#include "harness/article/printed_curves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace loopbench::harness {
namespace {

std::function<double(double)> polynomial(std::vector<double> highest_first) {
  return [c = std::move(highest_first)](double x) {
    double out = 0.0;
    for (const double each : c) out = out * x + each;
    return out;
  };
}

}  // namespace

const std::vector<PrintedCurve>& printed_curves() {
  constexpr double q1 = 6.981, q2 = -8.05;
  static const double root = std::sqrt(q1 * q1 / 4.0 - q2);
  static const std::vector<PrintedCurve> curves{
      {"Figure 5 a c e",
       "fr1_room",
       "parabola 1.238, 0.07842, -0.5163",
       polynomial({1.238, 0.07842, -0.5163}),
       3,
       0.0,
       {}},
      {"Figure 5 b d f",
       "fr1_room",
       "cubic -1.779, 0.4036, 0.7173, -17.71",
       polynomial({-1.779, 0.4036, 0.7173, -17.71}),
       4,
       0.0,
       {}},
      {"Figure 5 b d f, constant read as -0.1771",
       "fr1_room",
       "cubic -1.779, 0.4036, 0.7173, -0.1771",
       polynomial({-1.779, 0.4036, 0.7173, -0.1771}),
       4,
       0.0,
       {}},
      {"Figure 6 a c e",
       "fr1_room",
       "parabola 1.336, -0.2775, -0.7645",
       polynomial({1.336, -0.2775, -0.7645}),
       4,
       0.0,
       {}},
      {"Text, special segment",
       "fr1_room",
       "2.007 sin(104.6 x - 32.08)",
       [](double x) { return 2.007 * std::sin(104.6 * x - 32.08); },
       5,
       2.0 * std::numbers::pi / 104.6,
       {}},
      {"Figure 7 a c e",
       "fr3_office",
       "parabola -1.695, 3.683, -0.8821",
       polynomial({-1.695, 3.683, -0.8821}),
       4,
       0.0,
       {}},
      {"Figure 7 b d f",
       "fr3_office",
       "cubic 1.966, 8.281, 15.32, 5.843",
       polynomial({1.966, 8.281, 15.32, 5.843}),
       5,
       0.0,
       {}},
      {"Figure 8 left",
       "fr3_office",
       "parabola -2.943, -19.3, -31.76",
       polynomial({-2.943, -19.3, -31.76}),
       4,
       0.0,
       {}},
      {"Text, special segment",
       "fr3_office",
       "1.253 / (x^2 + 6.981 x - 8.05)",
       [](double x) { return 1.253 / (x * x + q1 * x + q2); },
       5,
       0.0,
       {-0.5 * q1 - root, -0.5 * q1 + root}},
  };
  return curves;
}

const std::vector<PrintedQuadric>& printed_quadrics() {
  static const std::vector<PrintedQuadric> quadrics{
      {"Figure 6 b d f",
       "fr1_room",
       "quadric -0.06873, -0.07766, 0.02006, 0.1498, -0.03972, 1.421",
       {-0.06873, -0.07766, 0.02006, 0.1498, -0.03972, 1.421},
       6},
      {"Figure 8 right",
       "fr3_office",
       "quadric -4.73, 0.482, 1.685, -1.523, 10.77, -4.589",
       {-4.73, 0.482, 1.685, -1.523, 10.77, -4.589},
       7},
  };
  return quadrics;
}

Meeting best_meeting(const PaperCell& raw, const PrintedCurve& curve, double sign) {
  const Trajectory& path = raw.dense.reference;
  Meeting best{std::numeric_limits<double>::infinity()};
  for (std::size_t first = 0; first + curve.nodes <= raw.keyframes.size(); ++first) {
    const double begin = raw.keyframes[first].stamp;
    const double end = raw.keyframes[first + curve.nodes - 1].stamp;
    double sum = 0.0;
    std::size_t count = 0;
    for (auto pose = std::ranges::lower_bound(path, begin, {}, &StampedPose::stamp);
         pose != path.end() && pose->stamp <= end;
         ++pose) {
      const Vector3& p = pose->world_from_body.translation;
      const double d = p.y() - sign * curve.f(p.x());
      sum += d * d;
      ++count;
    }
    const double rms = std::sqrt(sum / static_cast<double>(count));
    if (count >= 2 * curve.nodes && rms < best.rms) best = {rms, begin, end};
  }
  return best;
}

}  // namespace loopbench::harness
