#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "harness/article/ledger.hpp"
#include "harness/article/rank_correlation.hpp"
#include "harness/article/true_keyframes.hpp"
#include "methods/smoothers/manifold/psi.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

using methods::manifold::Nodes;
using metrics::kDegrees;

/// Number of tenths of the time in which ours has the lower rmse.
int better_tenths(const metrics::Evaluation& ours, const metrics::Evaluation& raw) {
  constexpr std::size_t kParts = 10;
  std::array<double, kParts> sum{};
  const std::size_t n = std::min(ours.estimate.size(), raw.estimate.size());
  const auto square = [](const metrics::Evaluation& e, std::size_t i) {
    return (e.estimate[i].world_from_body.translation - e.reference[i].world_from_body.translation)
        .squaredNorm();
  };
  for (std::size_t i = 0; i < n; ++i) sum[i * kParts / n] += square(ours, i) - square(raw, i);
  return static_cast<int>(std::ranges::count_if(sum, [](double s) { return s < 0.0; }));
}

/// One claim on one variant: its size on the closed run and how often it holds.
void overall(const std::vector<PaperCell>& cells,
             const std::string& sequence,
             const std::string& reading,
             const std::string& variant,
             std::vector<LedgerItem>& out) {
  const std::string who =
      fmt::format("{}, {}{}{}", sequence, reading, variant.empty() ? "" : " ", variant);
  const std::array statements{"the same level as ORB-SLAM2 as a whole (3-D ATE within 5 %)",
                              "better than ORB-SLAM2 in some areas",
                              "smoother than ORB-SLAM2's trajectory",
                              "the error is smaller, the cumulative error reduced"};
  std::array<LedgerItem, 4> items;
  for (std::size_t k = 0; k < items.size(); ++k) {
    items[k] = {"Section 4.2",
                fmt::format("{}: {}", who, statements[k]),
                "no such run",
                "",
                Verdict::cannot_be_judged};
  }
  std::array<std::size_t, 4> held{};
  std::size_t judged = 0;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const std::vector<const PaperCell*> runs = raw_runs(cells, sequence);
  for (const PaperCell* raw : runs) {
    const PaperCell* ours = find_cell(cells, *raw, reading, variant);
    const auto a = ours ? ate_3d(*ours, metrics::Times::dense) : std::nullopt;
    const auto b = ate_3d(*raw, metrics::Times::dense);
    if (!a || !b) continue;
    ++judged;
    const double change = *a / *b - 1.0;
    low = std::min(low, change);
    high = std::max(high, change);
    const int tenths = better_tenths(ours->dense, raw->dense);
    const std::array holds{std::abs(change) <= 0.05,
                           tenths > 0,
                           ours->roughness < (1.0 - kTiedChange) * raw->roughness,
                           change < -kTiedChange};
    for (std::size_t k = 0; k < 4; ++k) held[k] += holds[k] ? 1 : 0;
    if (raw != runs.front()) continue;
    for (std::size_t k = 0; k < 4; ++k) {
      items[k].verdict = holds[k] ? Verdict::holds : Verdict::does_not_hold;
    }
    if (std::abs(change) <= kTiedChange) items[3].verdict = Verdict::tie;
    items[0].ours =
        fmt::format("3-D ATE densely {:.4f} against {:.4f} m ({})", *a, *b, percent_change(change));
    items[1].ours = fmt::format("lower rmse in {} of 10 tenths of the time", tenths);
    items[2].ours = fmt::format("rms second difference {:.2f} against {:.2f} m/s^2 of the polyline",
                                ours->roughness,
                                raw->roughness);
    items[3].ours = fmt::format("{} in 3-D, densely", percent_change(change));
  }
  for (std::size_t k = 0; k < 4; ++k) {
    if (judged > 0) items[k].runs = fmt::format("in {} of {} runs", held[k], judged);
    if (judged > 0 && (k == 0 || k == 3)) {
      items[k].runs += fmt::format(", {} to {}", percent_change(low), percent_change(high));
    }
    out.push_back(items[k]);
  }
}

/// Errors of the next step: median angle between the predicted and the real direction [deg].
struct Prediction {
  double psi = 0.0, last = 0.0;
};

/// psi from the keyframes up to each node only, and the direction of the last step instead.
Prediction predict(const Trajectory& keyframes) {
  const Nodes nodes(keyframes);
  std::vector<double> psi_angles, last_angles;
  for (std::size_t i = 2; i + 1 < nodes.size(); ++i) {
    const Trajectory past(keyframes.begin() + static_cast<std::ptrdiff_t>(i >= 5 ? i - 5 : 0),
                          keyframes.begin() + static_cast<std::ptrdiff_t>(i + 1));
    const Nodes known(past);
    const Vector3 psi = methods::manifold::optimal_tangent(known,
                                                           methods::manifold::NodeSpline(known),
                                                           known.size() - 1,
                                                           2,
                                                           methods::manifold::PsiMean::discrete);
    if (!(nodes.step(i).norm() > 0.0) || !(nodes.step(i - 1).norm() > 0.0)) continue;
    psi_angles.push_back(methods::manifold::angle_between_directions(psi, nodes.step(i)));
    last_angles.push_back(
        methods::manifold::angle_between_directions(nodes.step(i - 1), nodes.step(i)));
  }
  if (psi_angles.empty()) return {};
  return {kDegrees * metrics::median(psi_angles), kDegrees * metrics::median(last_angles)};
}

LedgerItem psi_item(const std::string& sequence, const std::vector<const PaperCell*>& runs) {
  LedgerItem item{"Section 3.2",
                  sequence + ": psi gives the precise pose at the next moment",
                  "",
                  "",
                  Verdict::cannot_be_judged};
  std::size_t better = 0;
  for (const PaperCell* run : runs) {
    const Prediction p = predict(run->keyframes);
    if (p.psi < (1.0 - kTiedChange) * p.last) ++better;
    if (run != runs.front()) continue;
    item.ours = fmt::format(
        "median angle to the real next step {:.1f} deg with psi of the keyframes so far, {:.1f} "
        "deg "
        "with the direction of the last step",
        p.psi,
        p.last);
    item.verdict = p.psi < (1.0 - kTiedChange) * p.last   ? Verdict::holds
                   : p.psi < (1.0 + kTiedChange) * p.last ? Verdict::tie
                                                          : Verdict::does_not_hold;
  }
  item.runs = fmt::format("better than the last step in {} of {} runs", better, runs.size());
  return item;
}

/// Whether the processor time is below the recording's: only this is reproducible.
LedgerItem time_item(const std::vector<PaperCell>& cells, const std::string& sequence) {
  LedgerItem item{"Section 3.2",
                  sequence + ": real time, as processor time below the recording's",
                  "no such run",
                  "",
                  Verdict::cannot_be_judged};
  std::size_t faster = 0, count = 0;
  for (const PaperCell& cell : cells) {
    const methods::Report& report = cell.result.report;
    if (cell.sequence != sequence || cell.reading != "text" || report.counts.empty()) continue;
    const std::vector<double>& seconds =
        cell.result.cpu_seconds.empty() ? cell.result.seconds : cell.result.cpu_seconds;
    if (seconds.empty()) continue;
    const double duration = cell.keyframes.back().stamp - cell.keyframes.front().stamp;
    ++count;
    if (seconds.front() < duration) ++faster;
  }
  if (count == 0) return item;
  item.ours = "the whole run is computed in less time than was recorded";
  item.runs = fmt::format("in {} of {} rows", faster, count);
  item.verdict = faster == count ? Verdict::holds : Verdict::does_not_hold;
  return item;
}

/// Rank correlation of the error that a step adds with the step's true speed and rotation angle.
struct ErrorGrowth {
  double speed = 0.0, rotation = 0.0;
  std::size_t steps = 0;

  /// Three standard errors of the correlation of independent values.
  double threshold() const { return 3.0 / std::sqrt(static_cast<double>(steps) - 1.0); }
};

ErrorGrowth error_growth(const PaperCell& run) {
  const Trajectory truth = true_keyframes(run);
  std::vector<double> speeds, angles, growth;
  auto estimate = run.keyframes.begin();
  Vector3 last_error = Vector3::Zero();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    while (estimate->stamp < truth[i].stamp) ++estimate;
    const Pose& pose = truth[i].world_from_body;
    const Vector3 error = estimate->world_from_body.translation - pose.translation;
    if (i > 0) {
      const Pose& before = truth[i - 1].world_from_body;
      speeds.push_back((pose.translation - before.translation).norm() /
                       (truth[i].stamp - truth[i - 1].stamp));
      angles.push_back(angle_between(before.rotation, pose.rotation));
      growth.push_back((error - last_error).norm());
    }
    last_error = error;
  }
  return {rank_correlation(growth, speeds), rank_correlation(growth, angles), growth.size()};
}

/// The article's premise, for speed or for rotation.
LedgerItem premise_item(const std::string& sequence,
                        const std::vector<const PaperCell*>& runs,
                        double ErrorGrowth::*on,
                        const char* name) {
  LedgerItem item{"Abstract, section 3",
                  fmt::format("{}: the motion error is related to the {}", sequence, name),
                  "",
                  "",
                  Verdict::cannot_be_judged};
  double low = 1.0, high = -1.0;
  std::size_t related = 0;
  for (const PaperCell* run : runs) {
    const ErrorGrowth growth = error_growth(*run);
    if (growth.steps < 10) continue;
    const bool holds = growth.*on > growth.threshold();
    low = std::min(low, growth.*on);
    high = std::max(high, growth.*on);
    if (holds) ++related;
    if (run != runs.front()) continue;
    item.ours = fmt::format(
        "rank correlation {:+.2f} with the error that a step between keyframes adds; above {:.2f} "
        "counts as related (three standard errors)",
        growth.*on,
        growth.threshold());
    item.verdict = holds ? Verdict::holds : Verdict::does_not_hold;
  }
  if (low <= high) {
    item.runs = fmt::format(
        "{:+.2f} to {:+.2f}, related in {} of {} runs", low, high, related, runs.size());
  }
  return item;
}

}  // namespace

std::vector<LedgerItem> trajectory_items(const std::vector<PaperCell>& cells) {
  std::vector<LedgerItem> out;
  for (const char* sequence : {"fr1_room", "fr3_office"}) {
    const std::vector<const PaperCell*> runs = raw_runs(cells, sequence);
    if (runs.empty()) continue;
    out.push_back(premise_item(sequence, runs, &ErrorGrowth::speed, "speed"));
    out.push_back(premise_item(sequence, runs, &ErrorGrowth::rotation, "rotation angle"));
    for (const char* variant : {"N4 parabola", "M7"}) {
      overall(cells, sequence, "text", variant, out);
    }
    out.push_back(psi_item(sequence, runs));
    out.push_back(time_item(cells, sequence));
  }
  if (out.empty()) return out;
  out.push_back({"Section 3.2",
                 "real time, as a pose that is known when it is needed",
                 "spline, joints and windows need later keyframes: it is not an online method",
                 "",
                 Verdict::does_not_hold});
  out.push_back(
      {"Title, abstract",
       "a loop closure detection method that improves the accuracy of loop closure "
       "detection",
       "no loop is detected or used: input and output are keyframe positions. What it does "
       "to given closures is in argument.md (closure residual)",
       "",
       Verdict::does_not_hold});
  out.push_back({"Abstract, section 3",
                 "existing methods distribute the error evenly",
                 "true of uniform distribution (argument.md), not of the article's own input: "
                 "ORB-SLAM2 optimises a pose graph and adjusts bundles",
                 "",
                 Verdict::does_not_hold});
  return out;
}

std::vector<LedgerItem> own_reading_items(const std::vector<PaperCell>& cells) {
  std::vector<LedgerItem> out;
  for (const char* sequence : {"fr1_room", "fr3_office"}) {
    if (raw_runs(cells, sequence).empty()) continue;
    overall(cells, sequence, "guarded", "N4 parabola", out);
    overall(cells, sequence, "guarded", "M7", out);
    overall(cells, sequence, kNaturalSpline, "", out);
  }
  return out;
}

}  // namespace loopbench::harness
