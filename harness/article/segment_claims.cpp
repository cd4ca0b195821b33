#include "harness/article/segment_claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "datasets/core/polyline.hpp"
#include "methods/smoothers/manifold/dm.hpp"
#include "methods/smoothers/manifold/kappa.hpp"
#include "methods/smoothers/manifold/window_fit.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

using methods::manifold::Family;
using methods::manifold::Kappa;
using methods::manifold::Nodes;
using methods::manifold::NodeSpline;
using methods::manifold::PlanarPiece;
using methods::manifold::PlanarRule;
using methods::manifold::Window;
using methods::manifold::WindowFitter;

constexpr std::array kFamilies{Family::poly2, Family::poly3, Family::sin1, Family::rat02};
constexpr const char* kNames[] = {"parabola", "cubic", "sine", "rational"};
constexpr std::size_t kNodes = 5;    // one more than the cubic's unknowns: no exact interpolation
constexpr double kTieMargin = 0.01;  // [of the smaller error]

struct Range {
  double low, high;

  bool holds(double value) const { return low <= value && value <= high; }
};

/// Values printed next to the article's figures.
struct Quoted {
  const char* where;
  const char* sequence;
  std::size_t family;  // index into kFamilies
  Range speed;         // [m/s]
  Range kappa;         // printed without unit; assumed [rad] per keyframe
};
constexpr Quoted kQuoted[] = {
    {"Figure 5 a c e", "fr1_room", 0, {0.3845, 0.7014}, {0.002, 0.04}},
    {"Figure 5 b d f", "fr1_room", 1, {0.2214, 0.4508}, {0.005, 0.018}},
    {"Figure 6 a c e", "fr1_room", 0, {0.1331, 0.4580}, {0.0071, 0.0265}},
    {"Text, special segment", "fr1_room", 2, {0.1006, 0.1770}, {0.0548, 0.0586}},
    {"Figure 7 a c e", "fr3_office", 0, {0.2017, 0.3832}, {0.0357, 0.0512}},
    {"Figure 7 b d f", "fr3_office", 1, {0.2670, 0.2774}, {0.0011, 0.0032}},
    {"Figure 8 left", "fr3_office", 0, {0.1998, 0.3035}, {0.0071, 0.0265}},
    {"Text, special segment", "fr3_office", 3, {0.1006, 0.1770}, {0.1271, 0.2248}},
};

/// Squared distances of each family to the reference; a rejected window uses a parabola, as in dm.
struct Contest {
  std::array<double, kFamilies.size()> squares{};
  std::array<std::size_t, kFamilies.size()> rejected{};
  std::size_t samples = 0;
  std::size_t windows = 0;

  double rms(std::size_t family) const {
    return std::sqrt(squares[family] / static_cast<double>(samples));
  }
  std::string text() const {
    std::string out = fmt::format("{} windows", windows);
    for (std::size_t k = 0; samples > 0 && k < kFamilies.size(); ++k) {
      out += fmt::format(", {} {:.2f} mm", kNames[k], 1e3 * rms(k));
      if (rejected[k] > 0) out += fmt::format(" ({} rejected)", rejected[k]);
    }
    return out;
  }
  bool won_by(std::size_t family) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < kFamilies.size(); ++k) least = std::min(least, rms(k));
    return 2 * rejected[family] <= windows && rms(family) <= (1.0 + kTieMargin) * least;
  }
};

/// The reference at the keyframe stamps, so that the remaining error is due to the family.
Trajectory true_keyframes(const PaperCell& raw) {
  const Polyline truth(raw.dense.reference);
  std::vector<double> known;
  for (const StampedPose& pose : raw.keyframes) {
    if (pose.stamp >= truth.start() && pose.stamp <= truth.end()) known.push_back(pose.stamp);
  }
  return truth.sample(known);
}

/// The reference path, its z axis up, and nodes on it.
struct Run {
  explicit Run(const PaperCell& raw) : Run(raw, true_keyframes(raw)) {}
  Run(const PaperCell& raw, const Trajectory& keyframes)
      : truth(raw.dense.reference),
        nodes(keyframes),
        spline(nodes),
        kappa(kappas(nodes,
                     raw.keyframes,
                     Kappa::turn_per_kf,
                     methods::manifold::CurveSpace::space,
                     Vector3::UnitZ())) {}

  double speed(std::size_t edge) const { return nodes.step(edge).norm() / nodes.duration(edge); }

  bool is_in(std::size_t first, const Range& speeds, const Range& rotation_angles) const {
    for (std::size_t edge = first; edge + 1 < first + kNodes; ++edge) {
      if (!speeds.holds(speed(edge))) return false;
      if (edge > first && !rotation_angles.holds(kappa[edge])) return false;
    }
    return true;
  }

  void enter(std::size_t first, Contest& contest) const {
    const methods::manifold::NodeRange range{first, first + kNodes - 1};
    const Window window{range, range};
    const Vector3 up = Vector3::UnitZ();
    const PlanarRule rule{.size = kNodes};
    const WindowFitter fitter{nodes, spline, up, rule};
    if (!fitter.admits(window)) return;
    std::vector<PlanarPiece> pieces;
    for (std::size_t k = 0; k < kFamilies.size(); ++k) {
      const auto piece = fitter.fit(window, {&kFamilies[k], 1});
      if (!piece && k == 0) return;
      if (!piece) ++contest.rejected[k];
      pieces.push_back(piece ? *piece : pieces.front());
    }
    ++contest.windows;
    auto pose = std::ranges::lower_bound(truth, nodes.stamps[range.first], {}, &StampedPose::stamp);
    for (std::size_t edge = range.first; edge < range.last; ++edge) {
      for (; pose != truth.end() && pose->stamp <= nodes.stamps[edge + 1]; ++pose) {
        const methods::manifold::SplinePoint position = spline.at(edge, pose->stamp);
        const Vector3 reference_point = pose->world_from_body.translation - nodes.base;
        for (std::size_t k = 0; k < pieces.size(); ++k) {
          contest.squares[k] +=
              (value_of_piece(pieces[k], position) - reference_point).squaredNorm();
        }
        ++contest.samples;
      }
    }
  }

  Contest contest(const Range& speeds, const Range& rotation_angles) const {
    Contest out;
    for (std::size_t first = 0; first + kNodes <= nodes.size(); ++first) {
      if (is_in(first, speeds, rotation_angles)) enter(first, out);
    }
    return out;
  }

  const Trajectory& truth;
  Nodes nodes;
  NodeSpline spline;
  std::vector<double> kappa;
};

Claim family_claim(const Quoted& quoted, const Run& run) {
  constexpr Range any{0.0, std::numeric_limits<double>::infinity()};
  Claim claim{fmt::format("{}: a {} at {} to {} m/s and kappa {} to {}",
                          quoted.where,
                          kNames[quoted.family],
                          quoted.speed.low,
                          quoted.speed.high,
                          quoted.kappa.low,
                          quoted.kappa.high),
              fmt::format("{}, truth at the keyframes, chord axes", quoted.sequence),
              Verdict::cannot_be_judged,
              ""};
  const Contest both = run.contest(quoted.speed, quoted.kappa);
  const Contest fast = run.contest(quoted.speed, any);
  claim.because = fmt::format("in both ranges {}; by speed alone {}", both.text(), fast.text());
  const Contest& decides = both.samples > 0 ? both : fast;
  if (decides.samples > 0) {
    claim.verdict = decides.won_by(quoted.family) ? Verdict::holds : Verdict::does_not_hold;
  }
  return claim;
}

Claim smooth_claim(const std::string& sequence, const PaperCell& raw) {
  Claim claim{"Text: segments meet C1 at higher speed, C0 at lower",
              fmt::format("{}, closed, chord axes, N3 without joints", sequence),
              Verdict::cannot_be_judged,
              "too few joints"};
  Problem problem;
  problem.keyframes = raw.keyframes;
  methods::Report unused;
  const auto curve = methods::Dm({.planar = 3,
                                  .gap = {{}, {}},
                                  .up = methods::manifold::UpDirection::world_z,
                                  .joint = {.kind = methods::manifold::JointKind::none}})
                         .fit(problem, unused, {});
  if (!curve) return claim;
  const Nodes nodes(raw.keyframes);
  const auto speed = [&](std::size_t edge) {
    return nodes.step(edge).norm() / nodes.duration(edge);
  };
  const std::vector<std::uint32_t>& piece = curve->parts().planar->piece_of_edge;
  std::vector<std::pair<double, double>> joints;  // speed, angle
  for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
    if (piece[i - 1] == piece[i]) continue;
    const Vector3 before = curve->motion(i - 1, nodes.stamps[i]).first;
    const Vector3 after = curve->motion(i, nodes.stamps[i]).first;
    joints.emplace_back(0.5 * (speed(i - 1) + speed(i)),
                        methods::manifold::angle_between_directions(before, after));
  }
  if (joints.size() < 4) return claim;
  std::ranges::sort(joints);
  std::vector<double> slow, fast;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    (2 * k < joints.size() ? slow : fast).push_back(joints[k].second);
  }
  const double degrees = 180.0 / std::numbers::pi;
  const double slow_angle = degrees * metrics::median(slow);
  const double fast_angle = degrees * metrics::median(fast);
  claim.verdict = fast_angle < 1.0 && slow_angle >= 1.0 ? Verdict::holds : Verdict::does_not_hold;
  claim.because = fmt::format(
      "median angle at {} joints: {:.2f} deg above {:.3f} m/s, {:.2f} deg below; C1 would be 0",
      joints.size(),
      fast_angle,
      joints[joints.size() / 2].first,
      slow_angle);
  return claim;
}

}  // namespace

std::vector<Claim> check_segment_claims(const std::vector<PaperCell>& cells) {
  std::vector<Claim> out;
  for (const char* sequence : {"fr1_room", "fr3_office"}) {
    PaperCell like;
    like.sequence = sequence;
    like.input = "closed";
    const PaperCell* raw = find_cell(cells, like, "", "ORB_SLAM2");
    if (raw == nullptr || raw->keyframes.size() < kNodes) continue;
    const Run run(*raw);
    for (const Quoted& quoted : kQuoted) {
      if (quoted.sequence == std::string(sequence)) out.push_back(family_claim(quoted, run));
    }
    out.push_back(smooth_claim(sequence, *raw));
  }
  return out;
}

}  // namespace loopbench::harness
