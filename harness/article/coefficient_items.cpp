#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "harness/article/ledger.hpp"
#include "harness/article/printed_curves.hpp"
#include "harness/article/reported.hpp"
#include "harness/article/true_keyframes.hpp"

namespace loopbench::harness {
namespace {

/// ATE that the article's table prints for this N or M [m].
double printed_ate(const std::string& sequence, const std::string& variant) {
  const auto row = std::ranges::find_if(reported_rows(), [&](const ReportedRow& r) {
    return r.sequence == sequence && r.variant == variant;
  });
  return row->ate;
}

/// Whether a printed curve is as near to the reference as the article's table states.
Verdict meets(double rms, double printed) {
  if (rms <= printed) return Verdict::holds;
  return rms <= (1.0 + kTiedFit) * printed ? Verdict::tie : Verdict::does_not_hold;
}

/// The run whose path no curve of this sequence was fitted to; nullptr without one.
const PaperCell* control(const std::vector<PaperCell>& cells, const std::string& sequence) {
  const std::vector<const PaperCell*> runs =
      raw_runs(cells, sequence == "fr1_room" ? "fr3_office" : "fr1_room");
  return runs.empty() ? nullptr : runs.front();
}

/// rms of the vertical distance of a printed quadric to poses [m].
double quadric_rms(std::span<const StampedPose> poses, const PrintedQuadric& q, double sign) {
  double sum = 0.0;
  for (const StampedPose& pose : poses) {
    const Vector3& p = pose.world_from_body.translation;
    const double d = p.z() - sign * q.height(p.x(), p.y());
    sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(poses.size()));
}

/// The least over all windows of `nodes` keyframes of the reference.
double nearest_window(const Trajectory& keyframes, const PrintedQuadric& q) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t first = 0; first + q.nodes <= keyframes.size(); ++first) {
    least = std::min(least, quadric_rms(std::span(keyframes).subspan(first, q.nodes), q, 1.0));
  }
  return least;
}

std::string length_text(double metres) {
  return metres < 0.1 ? fmt::format("{:.1f} mm", 1e3 * metres) : fmt::format("{:.2f} m", metres);
}

}  // namespace

std::vector<LedgerItem> coefficient_items(const std::vector<PaperCell>& cells) {
  std::vector<LedgerItem> out;
  for (const PrintedCurve& curve : printed_curves()) {
    const std::vector<const PaperCell*> runs = raw_runs(cells, curve.sequence);
    if (runs.empty()) continue;
    const Trajectory& path = runs.front()->dense.reference;
    const Meeting plus = best_meeting(*runs.front(), curve, 1.0);
    const Meeting minus = best_meeting(*runs.front(), curve, -1.0);
    double least = plus.rms, most = plus.rms;
    for (const PaperCell* run : runs) {
      const double each = best_meeting(*run, curve, 1.0).rms;
      least = std::min(least, each);
      most = std::max(most, each);
    }
    std::string remark;
    if (curve.wavelength > 0.0) {
      const double step =
          path_length(path) / static_cast<double>(runs.front()->keyframes.size() - 1);
      remark = fmt::format(
          "; its wavelength {:.3f} m is shorter than the mean keyframe spacing {:.3f} "
          "m, so keyframes cannot determine it",
          curve.wavelength,
          step);
    }
    for (const double pole : curve.poles) remark += fmt::format("; pole at x = {:.3f} m", pole);
    if (const PaperCell* other = control(cells, curve.sequence)) {
      remark += fmt::format(
          "; on {} {}", other->sequence, length_text(best_meeting(*other, curve, 1.0).rms));
    }
    const double printed = printed_ate(curve.sequence, fmt::format("N{}", curve.nodes));
    out.push_back({curve.where,
                   fmt::format("{}: {}; ATE along y {}", curve.sequence, curve.text, printed),
                   fmt::format("nearest {} keyframes of the reference: rms {} ({} with y = -f){}",
                               curve.nodes,
                               length_text(plus.rms),
                               length_text(minus.rms),
                               remark),
                   fmt::format("{} to {}", length_text(least), length_text(most)),
                   meets(plus.rms, printed)});
  }
  for (const PrintedQuadric& quadric : printed_quadrics()) {
    const std::vector<const PaperCell*> runs = raw_runs(cells, quadric.sequence);
    if (runs.empty()) continue;
    const Trajectory& path = runs.front()->dense.reference;
    const double printed = printed_ate(quadric.sequence, fmt::format("M{}", quadric.nodes));
    out.push_back({quadric.where,
                   fmt::format("{}: {}; ATE along z {}", quadric.sequence, quadric.text, printed),
                   fmt::format("rms over the whole reference {} ({} with the printed sign, z = "
                               "-q), over the nearest {} keyframes of it {}",
                               length_text(quadric_rms(path, quadric, 1.0)),
                               length_text(quadric_rms(path, quadric, -1.0)),
                               quadric.nodes,
                               length_text(nearest_window(true_keyframes(*runs.front()), quadric))),
                   "",
                   meets(quadric_rms(path, quadric, 1.0), printed)});
  }
  return out;
}

}  // namespace loopbench::harness
