#include "harness/article/paper_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "harness/plot/gnuplot.hpp"
#include "methods/smoothers/manifold/segments.hpp"

namespace loopbench::harness {
namespace {

constexpr const char* kRed = "#d62728";
constexpr const char* kBlue = "#1f4fd6";
constexpr const char* kGreen = "#2ca02c";
constexpr std::size_t kMostPointsOfACurve = 600;  // per curve: more only enlarge the file

struct Span {
  double begin = -std::numeric_limits<double>::infinity();
  double end = std::numeric_limits<double>::infinity();
};

/// Values printed in the article for one sequence: thresholds, and speeds of its two local
/// segments.
struct Printed {
  const char* sequence;
  int local_figure;
  double speed_band;                        // [m/s]
  double turn_max;                          // [rad per keyframe]
  std::pair<double, double> first, second;  // speeds of the segments drawn [m/s]
};
constexpr Printed kPrinted[] = {
    {"fr1_room", 5, 0.33, 0.75, {0.3845, 0.7014}, {0.2214, 0.4508}},
    {"fr3_office", 7, 0.25, 0.42, {0.2017, 0.3832}, {0.2670, 0.2774}},
};

std::vector<Vector3> positions(const Trajectory& poses, const Span& span) {
  std::vector<Vector3> out;
  for (const StampedPose& p : poses) {
    if (p.stamp >= span.begin && p.stamp <= span.end) out.push_back(p.world_from_body.translation);
  }
  return thinned(out, kMostPointsOfACurve);
}

PlotPanel panel(const PaperCell& ours, const PaperCell& raw, const Span& span, bool spatial) {
  PlotPanel out;
  out.title = fmt::format("{}, {} {}", ours.sequence, ours.reading, ours.variant);
  out.spatial = spatial;
  out.series = {{"truth", kRed, false, positions(ours.dense.reference, span)},
                {"ORB_SLAM2", kGreen, false, positions(raw.dense.estimate, span)},
                {"ours", kBlue, false, positions(ours.dense.estimate, span)}};
  const bool is_local = std::isfinite(span.begin);
  if (is_local) {
    out.same_scale = false;  // centimetres across, metres along
    out.series.push_back({"keyframes", kGreen, true, positions(raw.keyframes, span)});
  }
  return out;
}

/// The segment of at least five nodes whose speed range overlaps the printed one best.
std::optional<Span> segment_like(const Trajectory& keyframes,
                                 const Printed& printed,
                                 const std::pair<double, double>& speeds) {
  const methods::manifold::Nodes nodes(keyframes);
  std::optional<Span> best;
  double best_overlap = -std::numeric_limits<double>::infinity();
  for (const methods::manifold::NodeRange& run :
       methods::manifold::segments(nodes, {printed.speed_band, printed.turn_max})) {
    if (run.nodes() < 5) continue;
    double low = std::numeric_limits<double>::infinity();
    double high = 0.0;
    for (std::size_t e = run.first; e < run.last; ++e) {
      const double speed = nodes.step(e).norm() / nodes.duration(e);
      low = std::min(low, speed);
      high = std::max(high, speed);
    }
    // Intersection over union; negative for disjoint ranges, so that the nearest wins.
    const double overlap = (std::min(high, speeds.second) - std::max(low, speeds.first)) /
                           (std::max(high, speeds.second) - std::min(low, speeds.first));
    if (overlap > best_overlap) {
      best_overlap = overlap;
      best = Span{nodes.stamps[run.first], nodes.stamps[run.last]};
    }
  }
  return best;
}

}  // namespace

std::vector<std::string> paper_figures(const std::vector<PaperCell>& cells,
                                       const std::string& reading,
                                       const std::filesystem::path& folder) {
  std::vector<std::string> written;
  const auto write = [&](int figure, const std::vector<PlotPanel>& panels) {
    if (panels.empty()) return;
    const std::string name = fmt::format("figure{}.svg", figure);
    write_figure(folder / name, panels, 2);
    written.push_back(name);
  };
  for (const Printed& printed : kPrinted) {
    PaperCell like;
    like.sequence = printed.sequence;
    like.input = "closed";
    const PaperCell* raw = find_cell(cells, like, "", "ORB_SLAM2");
    if (raw == nullptr || raw->keyframes.empty()) continue;
    const auto first = segment_like(raw->keyframes, printed, printed.first);
    const auto second = segment_like(raw->keyframes, printed, printed.second);
    std::vector<PlotPanel> local;
    std::vector<PlotPanel> global;
    for (int row = 0; row < 3; ++row) {
      const PaperCell* planar = find_cell(cells, like, reading, fmt::format("N{}", 3 + row));
      const PaperCell* spatial = find_cell(cells, like, reading, fmt::format("M{}", 6 + row));
      if (planar != nullptr && first && second) {
        local.push_back(panel(*planar, *raw, *first, false));
        local.push_back(panel(*planar, *raw, *second, false));
      }
      if (planar != nullptr) global.push_back(panel(*planar, *raw, {}, false));
      if (spatial != nullptr) global.push_back(panel(*spatial, *raw, {}, true));
    }
    write(printed.local_figure, local);
    write(printed.local_figure + 1, global);
  }
  return written;
}

}  // namespace loopbench::harness
