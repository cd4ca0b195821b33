#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/article/ledger.hpp"
#include "harness/article/rank_correlation.hpp"
#include "harness/article/true_keyframes.hpp"
#include "methods/smoothers/manifold/nodes.hpp"

namespace loopbench::harness {
namespace {

using methods::manifold::angle_between_directions;
using methods::manifold::Nodes;

/// Basis function of order k on the knots m_t = t: equation 12 as printed, or with the second
/// numerator m_{t+k} - u.
double basis(int t, int k, double u, bool as_printed) {
  if (k == 1) return t <= u && u < t + 1 ? 1.0 : 0.0;
  const double second = as_printed ? t + k : t + k - u;
  return ((u - t) * basis(t, k - 1, u, as_printed) + second * basis(t + 1, k - 1, u, as_printed)) /
         (k - 1);
}

/// Largest deviation of the cubic basis functions' sum from 1.
double partition_error(bool as_printed) {
  double worst = 0.0;
  for (double u = 4.0; u < 8.0; u += 0.125) {
    double sum = 0.0;
    for (int t = 0; t < 8; ++t) sum += basis(t, 4, u, as_printed);
    worst = std::max(worst, std::abs(sum - 1.0));
  }
  return worst;
}

/// Rank correlation of speed and torsion over the edges: torsion is the angle between the binormals
/// at both ends, per second (equation 5 with t as time) or per metre.
double speed_and_torsion(const Trajectory& poses, bool per_metre) {
  const Nodes nodes(poses);
  std::vector<double> speed, torsion;
  for (std::size_t edge = 1; edge + 2 < nodes.size(); ++edge) {
    const Vector3 before = nodes.step(edge - 1).cross(nodes.step(edge));
    const Vector3 after = nodes.step(edge).cross(nodes.step(edge + 1));
    const double length = nodes.step(edge).norm();
    if (!(before.norm() > 0.0) || !(after.norm() > 0.0) || !(length > 0.0)) continue;
    speed.push_back(length / nodes.duration(edge));
    torsion.push_back(angle_between_directions(before, after) /
                      (per_metre ? length : nodes.duration(edge)));
  }
  return rank_correlation(speed, torsion);
}

}  // namespace

std::vector<LedgerItem> equation_items(const std::vector<PaperCell>& cells) {
  std::vector<LedgerItem> out;
  std::string lengths, correlations, all_correlations, slices, heights;
  double strongest = -1.0;
  for (const char* sequence : {"fr1_room", "fr3_office"}) {
    const std::vector<const PaperCell*> runs = raw_runs(cells, sequence);
    if (runs.empty()) continue;
    const Trajectory truth = true_keyframes(*runs.front());
    const Nodes nodes(truth);
    double low = std::numeric_limits<double>::infinity(), high = 0.0;
    for (std::size_t edge = 0; edge + 1 < nodes.size(); ++edge) {
      const double speed = nodes.step(edge).norm() / nodes.duration(edge);
      low = std::min(low, speed);
      high = std::max(high, speed);
    }
    double bottom = std::numeric_limits<double>::infinity(), top = -bottom;
    for (const StampedPose& pose : runs.front()->dense.reference) {
      bottom = std::min(bottom, pose.world_from_body.translation.z());
      top = std::max(top, pose.world_from_body.translation.z());
    }
    lengths +=
        fmt::format("{}{} {:.3f} to {:.3f}", lengths.empty() ? "" : ", ", sequence, low, high);
    heights +=
        fmt::format("{}{} {:.2f} to {:.2f} m", heights.empty() ? "" : ", ", sequence, bottom, top);
    correlations += fmt::format("{}{} {:+.2f} per second, {:+.2f} per metre",
                                correlations.empty() ? "" : "; ",
                                sequence,
                                speed_and_torsion(truth, false),
                                speed_and_torsion(truth, true));
    strongest = std::max(strongest, speed_and_torsion(truth, false));
    double least = 1.0, most = -1.0;
    for (const PaperCell* run : runs) {
      const double each = speed_and_torsion(run->keyframes, false);
      least = std::min(least, each);
      most = std::max(most, each);
    }
    all_correlations += fmt::format("{}{} {:+.2f} to {:+.2f} per second",
                                    all_correlations.empty() ? "" : "; ",
                                    sequence,
                                    least,
                                    most);
  }
  if (lengths.empty()) return out;
  out.push_back(
      {"Equation 2",
       "T = dS/dt is the tangent of an orthonormal frame, B = T x N, N = B x T",
       "the norm of dS/dt is the speed, in m/s for the reference at the keyframes: " + lengths +
           "; T must be divided by it. B needs N and N needs B: repaired as B = S' x S'' "
           "over its norm, N = B x T",
       "",
       Verdict::misprint});
  out.push_back(
      {"Equations 4 to 7",
       "torsion tau describes the speed: the faster, the larger",
       "rank correlation of speed and torsion, reference at the keyframes: " + correlations +
           ". The printed values of tau have the unit m/s, so they are speeds",
       all_correlations,
       strongest > 0.5 ? Verdict::holds : Verdict::does_not_hold});
  out.push_back({"Equations 6 and 7",
                 "tau again, for the angle between tangents",
                 "the text calls it kappa (curvature) and refers to equation 8: kappa is meant",
                 "",
                 Verdict::misprint});
  out.push_back(
      {"Equation 8",
       "F1(x, y, z) = 0 and F2(x, y, 0) = 0 give the projection on the xoy plane",
       "z = 0 gives a section of the surface; heights of the paths: " + heights + ". We project",
       "",
       Verdict::misprint});
  out.push_back({"Equation 9",
                 "an implicit curve F(x, y) = 0; printed examples have alpha(0,1) = 1",
                 "y = -f(x) as printed; the printed polynomials meet the reference as y = +f(x) "
                 "(see the coefficients below), so alpha(0,1) is -1",
                 "",
                 Verdict::misprint});
  constexpr int kUnknowns = 5 * 4 * 3 / 6 - 1;  // terms of order 2 in x, y, z, up to a factor
  out.push_back(
      {"Equation 10",
       "an implicit surface F(x, y, z) = 0 through M = 6, 7 or 8 nodes",
       fmt::format(
           "order 2 has {} unknowns, so such a surface passes through 8 nodes and any other "
           "point: it determines no z. The printed examples are explicit z = q(x, y) with 6, "
           "which is what is fitted here",
           kUnknowns),
       "",
       Verdict::misprint});
  out.push_back({"Equation 12",
                 "basis functions of a B-spline, second numerator m(t+k)",
                 fmt::format("the cubic basis sums to 1 within {:.1f} as printed and {:.0e} with "
                             "m(t+k) - u",
                             partition_error(true),
                             std::max(partition_error(false), 1e-16)),
                 "",
                 Verdict::misprint});
  out.push_back(
      {"Section 3.3",
       "second derivatives are equal at joints of parabolas",
       "equal value, slope and second derivative leave a parabola no freedom: all would be "
       "one. The reading text joins them by quintics through the nodes",
       "",
       Verdict::contradicts_itself});
  out.push_back(
      {"References and captions",
       "tau in (6), kappa in (8), N in (12), A for the coefficients of (10), control points "
       "F for P, knots t for m, figure 6 (f) M3 = 7, figure 6 (b, d, f) for fr3_office, [48] "
       "for the TUM benchmark",
       "(5), (7), (11), beta, P, m, M3 = 8 and figure 7 (b, d, f) are meant; [48] is another "
       "work",
       "",
       Verdict::misprint});
  return out;
}

}  // namespace loopbench::harness
