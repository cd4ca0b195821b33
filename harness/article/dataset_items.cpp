#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/article/ledger.hpp"
#include "harness/article/true_keyframes.hpp"
#include "methods/smoothers/manifold/segments.hpp"

namespace loopbench::harness {
namespace {

/// Facts printed for one sequence.
struct PrintedFacts {
  const char* sequence;
  std::size_t images, keyframes;
  double length;            // [m]
  double slowest, fastest;  // between keyframes [m/s]
  double speed_band;        // [m/s]
  double turn_max;          // no unit; assumed [rad] per keyframe
};
constexpr PrintedFacts kFacts[] = {
    {"fr1_room", 1362, 180, 15.989, 0.0593, 1.3648, 0.33, 0.75},
    {"fr3_office", 2585, 204, 21.455, 0.0372, 0.4292, 0.25, 0.42},
};

struct Speeds {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  double mean = 0.0;  // path length over duration
};

Speeds speeds(const Trajectory& poses) {
  const methods::manifold::Nodes nodes(poses);
  Speeds out;
  double length = 0.0;
  for (std::size_t edge = 0; edge + 1 < nodes.size(); ++edge) {
    const double step = nodes.step(edge).norm();
    length += step;
    out.low = std::min(out.low, step / nodes.duration(edge));
    out.high = std::max(out.high, step / nodes.duration(edge));
  }
  out.mean = length / (nodes.stamps.back() - nodes.stamps.front());
  return out;
}

bool is_within(double ours, double printed, double tolerance) {
  return std::abs(ours / printed - 1.0) <= tolerance;
}

Verdict when(bool holds) { return holds ? Verdict::holds : Verdict::does_not_hold; }

}  // namespace

std::vector<LedgerItem> dataset_items(const std::vector<PaperCell>& cells) {
  std::vector<LedgerItem> out;
  for (const PrintedFacts& facts : kFacts) {
    const std::vector<const PaperCell*> runs = raw_runs(cells, facts.sequence);
    if (runs.empty()) continue;
    const PaperCell& raw = *runs.front();
    const Trajectory truth = true_keyframes(raw);
    const std::string where = std::string("Section 4, ") + facts.sequence;
    const Speeds estimated = speeds(raw.keyframes);
    const Speeds real = speeds(truth);
    const double length = path_length(truth);

    std::string counts;
    for (const PaperCell* run : runs) {
      counts +=
          fmt::format("{}{} {}", counts.empty() ? "" : ", ", run->input, run->keyframes.size());
    }
    out.push_back(
        {where,
         fmt::format("{} images, {} keyframes", facts.images, facts.keyframes),
         "ORB-SLAM2's keyframe lists of the article are not public; frames of a closed run "
         "are resampled to as many",
         "keyframes: " + counts,
         Verdict::cannot_be_judged});
    out.push_back(
        {where,
         fmt::format("length of the real track {} m", facts.length),
         fmt::format("{:.3f} m through the reference at the keyframes, {:.3f} m at 100 Hz",
                     length,
                     path_length(raw.dense.reference)),
         "",
         when(is_within(length, facts.length, 0.05))});
    double low = estimated.low, high = estimated.high;
    for (const PaperCell* run : runs) {
      if (run->input.find("mono") != std::string::npos) continue;  // no metric speed
      const Speeds each = speeds(run->keyframes);
      low = std::min(low, each.low);
      high = std::max(high, each.high);
    }
    out.push_back(
        {where,
         fmt::format("speed between keyframes {} to {} m/s", facts.slowest, facts.fastest),
         fmt::format("{:.3f} to {:.3f} m/s, reference {:.3f} to {:.3f}",
                     estimated.low,
                     estimated.high,
                     real.low,
                     real.high),
         fmt::format("{:.3f} to {:.3f} m/s in all metric runs", low, high),
         when(is_within(estimated.low, facts.slowest, 0.5) &&
              is_within(estimated.high, facts.fastest, 0.25))});
    out.push_back(
        {where,
         fmt::format("speed band {} m/s", facts.speed_band),
         fmt::format(
             "the mean speed between the keyframes of the reference is {:.3f} m/s; the article "
             "gives no reason for the band",
             real.mean),
         "",
         Verdict::cannot_be_judged});
    const auto pieces = [&](const Trajectory& poses) {
      return methods::manifold::segments(methods::manifold::Nodes(poses),
                                         {facts.speed_band, facts.turn_max})
          .size();
    };
    std::string segments;
    for (const PaperCell* run : runs) {
      segments +=
          fmt::format("{}{} {}", segments.empty() ? "" : ", ", run->input, pieces(run->keyframes));
    }
    out.push_back(
        {where,
         fmt::format("speed band {} and curvature threshold {} cut the run into segments",
                     facts.speed_band,
                     facts.turn_max),
         fmt::format("{} segments with kappa as angle per keyframe [rad]; {} on the reference "
                     "at the keyframes. The number is not printed",
                     pieces(raw.keyframes),
                     pieces(truth)),
         segments,
         Verdict::cannot_be_judged});
  }
  return out;
}

}  // namespace loopbench::harness
