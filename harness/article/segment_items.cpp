#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "harness/article/ledger.hpp"
#include "harness/article/quoted_segments.hpp"
#include "harness/article/true_keyframes.hpp"
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

/// A family at its own N.
struct Candidate {
  const char* name;
  Family family;
  std::size_t nodes;
};
constexpr Candidate kCandidates[] = {
    {"N3 parabola", Family::poly2, 3},
    {"N4 parabola", Family::poly2, 4},
    {"N4 cubic", Family::poly3, 4},
    {"N5 cubic", Family::poly3, 5},
    {"N5 sine", Family::sin1, 5},
    {"N5 rational", Family::rat02, 5},
};
constexpr std::size_t kCandidateCount = std::size(kCandidates);

/// rms distance of one candidate to the reference over its windows [m].
struct Fit {
  double squares = 0.0;
  std::size_t samples = 0, windows = 0, rejected = 0;

  double rms() const {
    if (samples == 0) return std::numeric_limits<double>::quiet_NaN();
    return std::sqrt(squares / static_cast<double>(samples));
  }
};
using Fits = std::array<Fit, kCandidateCount>;

/// The reference path, its z axis up, and nodes on it.
struct TruePath {
  explicit TruePath(const PaperCell& raw) : TruePath(raw, true_keyframes(raw)) {}
  TruePath(const PaperCell& raw, const Trajectory& keyframes)
      : truth(raw.dense.reference),
        nodes(keyframes),
        spline(nodes),
        kappa(kappas(nodes,
                     keyframes,
                     Kappa::turn_per_kf,
                     methods::manifold::CurveSpace::space,
                     Vector3::UnitZ())) {}

  bool is_in(std::size_t first,
             std::size_t count,
             const QuotedSegment& quoted,
             bool by_kappa) const {
    for (std::size_t edge = first; edge + 1 < first + count; ++edge) {
      if (!quoted.speed.holds(nodes.step(edge).norm() / nodes.duration(edge))) return false;
      if (by_kappa && edge > first && !quoted.kappa.holds(kappa[edge])) return false;
    }
    return true;
  }

  void add(std::size_t first, const Candidate& candidate, Fit& out) const {
    const methods::manifold::NodeRange range{first, first + candidate.nodes - 1};
    const Window window{range, range};
    const Vector3 up = Vector3::UnitZ();
    const PlanarRule rule{.size = candidate.nodes};
    const WindowFitter fitter{nodes, spline, up, rule};
    if (!fitter.admits(window)) return;
    const auto piece = fitter.fit(window, {&candidate.family, 1});
    if (!piece) {
      ++out.rejected;
      return;
    }
    ++out.windows;
    auto pose = std::ranges::lower_bound(truth, nodes.stamps[range.first], {}, &StampedPose::stamp);
    for (std::size_t edge = range.first; edge < range.last; ++edge) {
      for (; pose != truth.end() && pose->stamp <= nodes.stamps[edge + 1]; ++pose) {
        const auto position = spline.at(edge, pose->stamp);
        const Vector3 reference_point = pose->world_from_body.translation - nodes.base;
        out.squares += (value_of_piece(*piece, position) - reference_point).squaredNorm();
        ++out.samples;
      }
    }
  }

  Fits fits(const QuotedSegment& quoted, bool by_kappa) const {
    Fits out;
    for (std::size_t k = 0; k < kCandidateCount; ++k) {
      for (std::size_t first = 0; first + kCandidates[k].nodes <= nodes.size(); ++first) {
        if (is_in(first, kCandidates[k].nodes, quoted, by_kappa))
          add(first, kCandidates[k], out[k]);
      }
    }
    return out;
  }

  const Trajectory& truth;
  Nodes nodes;
  NodeSpline spline;
  std::vector<double> kappa;
};

/// Candidates that the article compares there: sine and rational only where it quotes them.
bool is_compared(std::size_t k, std::size_t quoted) { return k < 4 || k == quoted; }

Verdict verdict(const Fits& fits, std::size_t quoted) {
  if (fits[quoted].samples == 0) {
    return fits[quoted].rejected > 0 ? Verdict::does_not_hold : Verdict::cannot_be_judged;
  }
  double other = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < kCandidateCount; ++k) {
    if (k != quoted && is_compared(k, quoted) && fits[k].samples > 0) {
      other = std::min(other, fits[k].rms());
    }
  }
  if (std::abs(fits[quoted].rms() / other - 1.0) <= kTiedFit) return Verdict::tie;
  return fits[quoted].rms() < other ? Verdict::holds : Verdict::does_not_hold;
}

std::string text(const Fits& fits, std::size_t quoted) {
  std::string out;
  for (std::size_t k = 0; k < kCandidateCount; ++k) {
    if (!is_compared(k, quoted)) continue;
    out += fmt::format("{}{} ", out.empty() ? "" : ", ", kCandidates[k].name);
    out += fits[k].samples > 0
               ? fmt::format("{:.2f} mm ({} windows)", 1e3 * fits[k].rms(), fits[k].windows)
               : fmt::format("no window");
    if (fits[k].rejected > 0) out += fmt::format(", {} rejected", fits[k].rejected);
  }
  return out;
}

LedgerItem family_item(const QuotedSegment& quoted, const std::vector<const PaperCell*>& runs) {
  std::size_t index = 0;
  while (kCandidates[index].name != std::string(quoted.candidate)) ++index;
  LedgerItem item{quoted.where,
                  fmt::format("{}: {} is most consistent at {} to {} m/s and kappa {} to {}",
                              quoted.sequence,
                              quoted.candidate,
                              quoted.speed.low,
                              quoted.speed.high,
                              quoted.kappa.low,
                              quoted.kappa.high),
                  "",
                  "",
                  Verdict::cannot_be_judged};
  std::map<Verdict, std::size_t> counts;
  for (const PaperCell* run : runs) {
    const TruePath path(*run);
    const Fits fits = path.fits(quoted, false);
    const Verdict each = verdict(fits, index);
    ++counts[each];
    if (run != runs.front()) continue;
    const Fits both = path.fits(quoted, true);
    item.ours = fmt::format("at these speeds {}; {} windows also have the quoted kappa",
                            text(fits, index),
                            both[index].windows);
    item.verdict = each;
  }
  item.runs = fmt::format("best in {}, tie in {}, worse in {}, no window in {} of {} runs",
                          counts[Verdict::holds],
                          counts[Verdict::tie],
                          counts[Verdict::does_not_hold],
                          counts[Verdict::cannot_be_judged],
                          runs.size());
  return item;
}

/// Median angles between neighbouring tangents [deg].
struct JointAngles {
  double fast, slow;
  double speed;  ///< that divides both halves [m/s]
  std::size_t joints;
};

std::optional<JointAngles> joint_angles(const Trajectory& keyframes) {
  Problem problem;
  problem.keyframes = keyframes;
  methods::Report unused;
  const auto curve = methods::Dm({.planar = 3,
                                  .gap = {{}, {}},
                                  .up = methods::manifold::UpDirection::world_z,
                                  .joint = {.kind = methods::manifold::JointKind::none}})
                         .fit(problem, unused, {});
  if (!curve) return std::nullopt;
  const Nodes nodes(keyframes);
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
  if (joints.size() < 4) return std::nullopt;
  std::ranges::sort(joints);
  std::vector<double> slow, fast;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    (2 * k < joints.size() ? slow : fast).push_back(joints[k].second);
  }
  constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
  return JointAngles{kDegreesPerRadian * metrics::median(fast),
                     kDegreesPerRadian * metrics::median(slow),
                     joints[joints.size() / 2].first,
                     joints.size()};
}

LedgerItem joint_item(const std::string& sequence, const std::vector<const PaperCell*>& runs) {
  LedgerItem item{"Section 3.3",
                  sequence + ": segments meet C1 (angle 0) at higher speed, only C0 at lower",
                  "too few joints",
                  "",
                  Verdict::cannot_be_judged};
  std::size_t smaller = 0, judged = 0;
  for (const PaperCell* run : runs) {
    const auto angles = joint_angles(run->keyframes);
    if (!angles) continue;
    ++judged;
    if (angles->fast < angles->slow) ++smaller;
    if (run != runs.front()) continue;
    item.ours = fmt::format(
        "median angle at {} joints of N3 parabolas without joining: {:.2f} deg above {:.3f} m/s, "
        "{:.2f} deg below",
        angles->joints,
        angles->fast,
        angles->speed,
        angles->slow);
    item.verdict = angles->fast < 1.0            ? Verdict::holds
                   : angles->fast < angles->slow ? Verdict::other_size
                                                 : Verdict::does_not_hold;
  }
  item.runs = fmt::format("smaller at higher speed in {} of {} runs", smaller, judged);
  return item;
}

}  // namespace

std::vector<LedgerItem> segment_items(const std::vector<PaperCell>& cells) {
  std::vector<LedgerItem> out;
  for (const char* sequence : {"fr1_room", "fr3_office"}) {
    const std::vector<const PaperCell*> runs = raw_runs(cells, sequence);
    if (runs.empty()) continue;
    for (const QuotedSegment& quoted : kQuotedSegments) {
      if (quoted.sequence == std::string(sequence)) out.push_back(family_item(quoted, runs));
    }
    out.push_back(joint_item(sequence, runs));
  }
  if (out.empty()) return out;
  out.push_back({"Figures 6 and 8",
                 "kappa 0.0071 to 0.0265 on fr1_room and, to four digits, on fr3_office",
                 "one of the two ranges is probably a copy",
                 "",
                 Verdict::misprint});
  out.push_back({"Text, special segments",
                 "speeds 0.1006 to 0.1770 m/s on fr1_room and, to four digits, on fr3_office",
                 "one of the two ranges is probably a copy",
                 "",
                 Verdict::misprint});
  return out;
}

}  // namespace loopbench::harness
