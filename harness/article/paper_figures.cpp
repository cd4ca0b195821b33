#include "harness/article/paper_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "harness/article/quoted_segments.hpp"
#include "harness/plot/gnuplot.hpp"
#include "methods/smoothers/manifold/coefficients.hpp"
#include "methods/smoothers/manifold/segments.hpp"
#include "metrics/alignment/alignment.hpp"

namespace loopbench::harness {
namespace {

using methods::manifold::Nodes;

constexpr const char* kRed = "#d62728";
constexpr const char* kBlue = "#1f4fd6";
constexpr const char* kGreen = "#2ca02c";
constexpr std::size_t kMostPointsOfACurve = 600;  // per curve: more only enlarge the file
constexpr double kMargin = 0.3;                   // around the reference [m]

/// Segment of a run with its speeds [m/s] and kappa [rad per keyframe].
struct Drawn {
  double begin = -std::numeric_limits<double>::infinity();  // [s]
  double end = std::numeric_limits<double>::infinity();
  std::pair<double, double> speed, kappa;
  std::size_t first = 0, nodes = 0;
};

/// Values printed in the article for one sequence: thresholds, and its two local segments as
/// indices into kQuotedSegments.
struct Printed {
  const char* sequence;
  int local_figure;
  double speed_band;  // [m/s]
  double turn_max;    // [rad per keyframe]
  std::size_t left, right;
};
constexpr Printed kPrinted[] = {
    {"fr1_room", 5, 0.33, 0.75, 0, 1},
    {"fr3_office", 7, 0.25, 0.42, 4, 5},
};

std::vector<Vector3> positions(const Trajectory& poses, const Drawn& span) {
  std::vector<Vector3> out;
  for (const StampedPose& p : poses) {
    if (p.stamp >= span.begin && p.stamp <= span.end) out.push_back(p.world_from_body.translation);
  }
  return thinned(out, kMostPointsOfACurve);
}

/// Breaks a line where it leaves the box of the reference by more than the margin.
std::vector<Vector3> near_reference(std::vector<Vector3> points,
                                    const std::vector<Vector3>& reference) {
  Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 high = -low;
  for (const Vector3& p : reference) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  for (Vector3& p : points) {
    const bool is_inside =
        ((p - low).array() > -kMargin).all() && ((high - p).array() > -kMargin).all();
    if (!is_inside) p.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return points;
}

/// Poses of a method in the alignment of the raw run instead of its own, so that a curve through
/// the keyframes is drawn through them.
Trajectory in_alignment_of(const metrics::Evaluation& raw, const metrics::Evaluation& method) {
  Trajectory out = method.estimate;
  for (StampedPose& pose : out) {
    pose.world_from_body =
        method.alignment.reference_from_estimate.inverse() * pose.world_from_body;
    pose.world_from_body.translation /= method.alignment.scale;
  }
  return metrics::moved(raw.alignment, std::move(out));
}

PlotPanel panel(const PaperCell& ours, const PaperCell& raw, const Drawn& span, bool spatial) {
  PlotPanel out;
  out.spatial = spatial;
  const std::vector<Vector3> truth = positions(raw.dense.reference, span);
  out.series = {
      {"truth", kRed, false, truth, 3.5},
      {"ORB_SLAM2", kGreen, false, near_reference(positions(raw.dense.estimate, span), truth), 2.0},
      {"ours",
       kBlue,
       false,
       near_reference(positions(in_alignment_of(raw.dense, ours.dense), span), truth),
       1.0}};
  if (std::isfinite(span.begin)) {
    out.same_scale = false;  // centimetres across, metres along
    out.series.push_back({"keyframes", kGreen, true, positions(raw.keyframes, span)});
  }
  return out;
}

/// The segment of at least five nodes whose speed range overlaps the printed one best.
std::optional<Drawn> segment_like(const Trajectory& keyframes,
                                  const Printed& printed,
                                  const ClosedRange& speeds) {
  const Nodes nodes(keyframes);
  const std::vector<double> kappa = methods::manifold::kappas(nodes,
                                                              keyframes,
                                                              methods::manifold::Kappa::turn_per_kf,
                                                              methods::manifold::CurveSpace::space,
                                                              Vector3::UnitZ());
  std::optional<Drawn> best;
  double best_overlap = -std::numeric_limits<double>::infinity();
  for (const methods::manifold::NodeRange& run :
       methods::manifold::segments(nodes, {printed.speed_band, printed.turn_max})) {
    if (run.nodes() < 5) continue;
    Drawn drawn{nodes.stamps[run.first],
                nodes.stamps[run.last],
                {1e9, 0.0},
                {1e9, 0.0},
                run.first,
                run.nodes()};
    for (std::size_t e = run.first; e < run.last; ++e) {
      const double speed = nodes.step(e).norm() / nodes.duration(e);
      drawn.speed = {std::min(drawn.speed.first, speed), std::max(drawn.speed.second, speed)};
      if (e == run.first) continue;
      drawn.kappa = {std::min(drawn.kappa.first, kappa[e]), std::max(drawn.kappa.second, kappa[e])};
    }
    // Intersection over union; negative for disjoint ranges, so that the nearest wins.
    const double overlap =
        (std::min(drawn.speed.second, speeds.high) - std::max(drawn.speed.first, speeds.low)) /
        (std::max(drawn.speed.second, speeds.high) - std::min(drawn.speed.first, speeds.low));
    if (overlap > best_overlap) {
      best_overlap = overlap;
      best = drawn;
    }
  }
  return best;
}

/// y = f(x) through the segment's first N keyframes in the reference's axes.
std::string equation(const Trajectory& keyframes,
                     const Drawn& span,
                     std::size_t nodes,
                     int degree) {
  std::vector<methods::manifold::Vector2> points;
  for (std::size_t i = span.first; i < span.first + nodes; ++i) {
    points.emplace_back(keyframes[i].world_from_body.translation.head<2>());
  }
  const auto curve = methods::manifold::fit_polynomial(points, degree);
  return methods::manifold::text(methods::manifold::coefficients(curve, degree));
}

/// Panels with letters, and the lines of the caption.
struct Figure {
  std::vector<PlotPanel> panels;
  std::string caption;

  void add(PlotPanel panel, const std::string& title, const std::string& details) {
    const char letter = static_cast<char>('a' + panels.size());
    panel.title = fmt::format("({}) {}", letter, title);
    caption += fmt::format("- ({}) {}{}\n", letter, title, details.empty() ? "" : ": " + details);
    panels.push_back(std::move(panel));
  }
};

constexpr std::array kPlanar{"N3", "N4 parabola", "N5 cubic"};
constexpr std::array kSpatial{"M6", "M7", "M8"};

Figure local_figure(const std::vector<PaperCell>& cells,
                    const PaperCell& raw,
                    const std::string& reading,
                    const Printed& printed) {
  Figure out;
  for (std::size_t row = 0; row < kPlanar.size(); ++row) {
    const PaperCell* planar = find_cell(cells, raw, reading, kPlanar[row]);
    if (planar == nullptr || planar->dense.estimate.empty()) continue;
    for (const std::size_t quoted : {printed.left, printed.right}) {
      const auto span = segment_like(raw.keyframes, printed, kQuotedSegments[quoted].speed);
      if (!span) continue;
      out.add(panel(*planar, raw, *span, false),
              fmt::format("{} {} {}", printed.sequence, reading, kPlanar[row]),
              fmt::format(
                  "tau {:.4f} to {:.4f} m/s (printed {} to {}), kappa {:.4f} to {:.4f} rad per "
                  "keyframe (printed {} to {}){}",
                  span->speed.first,
                  span->speed.second,
                  kQuotedSegments[quoted].speed.low,
                  kQuotedSegments[quoted].speed.high,
                  span->kappa.first,
                  span->kappa.second,
                  kQuotedSegments[quoted].kappa.low,
                  kQuotedSegments[quoted].kappa.high,
                  reading == "text" ? "; first window: " +
                                          equation(raw.keyframes, *span, 3 + row, row == 2 ? 3 : 2)
                                    : ""));
    }
  }
  return out;
}

Figure global_figure(const std::vector<PaperCell>& cells,
                     const PaperCell& raw,
                     const std::string& reading) {
  Figure out;
  for (std::size_t row = 0; row < kPlanar.size(); ++row) {
    for (const bool spatial : {false, true}) {
      const char* variant = spatial ? kSpatial[row] : kPlanar[row];
      const PaperCell* ours = find_cell(cells, raw, reading, variant);
      if (ours == nullptr || ours->dense.estimate.empty()) continue;
      const auto axis = axis_numbers(*ours, spatial ? "z" : "y", metrics::Times::dense);
      out.add(panel(*ours, raw, {}, spatial),
              fmt::format("{} {} {}", raw.sequence, reading, variant),
              axis ? fmt::format("ATE along {} {:.4f} m, densely", spatial ? "z" : "y", axis->ate)
                   : "");
    }
  }
  return out;
}

}  // namespace

std::vector<PaperFigure> paper_figures(const std::vector<PaperCell>& cells,
                                       const std::string& reading,
                                       const std::filesystem::path& folder) {
  std::vector<PaperFigure> written;
  const auto write = [&](int number, const Figure& figure, const char* caption) {
    if (figure.panels.empty()) return;
    const std::string name = fmt::format("figure{}.svg", number);
    write_figure(folder / name, figure.panels, 2);
    written.push_back(
        {name, fmt::format("**Figure {}.** {}\n\n{}", number, caption, figure.caption)});
  };
  for (const Printed& printed : kPrinted) {
    PaperCell like;
    like.sequence = printed.sequence;
    like.input = "closed";
    const PaperCell* raw = find_cell(cells, like, "", "ORB_SLAM2");
    if (raw == nullptr || raw->keyframes.empty()) continue;
    write(printed.local_figure,
          local_figure(cells, *raw, reading, printed),
          "Segments fitted locally, N = 3, 4, 5 from top to bottom: the segments of our run whose "
          "speeds are nearest to the quoted ones.");
    write(printed.local_figure + 1,
          global_figure(cells, *raw, reading),
          "The complete run: left the xoy plane for N = 3, 4, 5, right xyz for M = 6, 7, 8.");
  }
  return written;
}

}  // namespace loopbench::harness
