#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "datasets/core/covariance.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/eval/eval_figures.hpp"
#include "harness/commands/eval/evaluated_parts.hpp"
#include "harness/commands/eval/evaluation_result.hpp"
#include "harness/commands/files/trajectory_selection.hpp"
#include "harness/commands/files/transformation.hpp"
#include "harness/commands/traj/traj_options.hpp"
#include "harness/commands/traj/traj_output.hpp"
#include "harness/commands/traj/trajectory_summary.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/text/counted.hpp"
#include "harness/sweep/text/printable.hpp"
#include "metrics/alignment/alignment.hpp"
#include "metrics/pairing/association.hpp"
#include "metrics/trajectory/projection.hpp"

namespace loopbench::harness {
namespace {

/// Paired poses. Throws InputError if there are none, or no common clock.
metrics::Paired paired(const TrajArguments& a,
                       const NamedTrajectory& reference,
                       const NamedTrajectory& estimate) {
  reject_two_clocks(reference, estimate, a.reading);
  metrics::Protocol rules;
  rules.association =
      a.association == "evo" ? metrics::Association::evo : metrics::Association::nearest;
  rules.max_diff = a.max_diff;
  rules.offset = a.offset;
  metrics::Paired out = metrics::associate(reference.file.poses, estimate.file.poses, rules);
  if (!out.reference.empty()) return out;
  throw InputError(fmt::format(
      "{}: no stamps are within {:g} s of stamps of {}", estimate.name, a.max_diff, a.reference));
}

int info(const TrajArguments& a) {
  std::vector<TrajectorySummary> all;
  for (const NamedTrajectory& each : read_all_named(a.files, a.reading)) {
    all.push_back(summarise(each.name, each.file, each.findings));
    const std::string assumed = assumed_period(each.file, a.reading);
    if (!assumed.empty()) all.back().remarks.push_back("no stamps: " + assumed + " (--period S)");
  }
  std::string out;
  for (const TrajectorySummary& summary : all) out += printable(text(summary));
  fmt::print("{}", a.json ? json(all) : out);
  return kExitOk;
}

/// Selects, shifts and projects in the order of evo_traj.
int convert(const TrajArguments& a) {
  return write_changed(a, [&](NamedTrajectory& each) {
    TrajectoryFile& file = each.file;
    if (a.downsample) file = selected(file, evenly_spaced(file.poses.size(), *a.downsample));
    if (a.motion_filter.size() == 2) {
      file = selected(file, by_motion(file.poses, a.motion_filter[0], a.motion_filter[1]));
    }
    shift_stamps(file, a.offset);
    if (a.plane == metrics::ProjectionPlane::none) return;
    metrics::project(file.poses, a.plane);
    file.covariances.clear();
  });
}

int merge_files(const TrajArguments& a) {
  NamedTrajectories all = read_all_named(a.files, a.reading);
  std::vector<TrajectoryFile> files;
  for (const NamedTrajectory& each : all) reject_two_clocks(all.front(), each, a.reading);
  for (NamedTrajectory& each : all) files.push_back(std::move(each.file));
  const Repeats repeats = a.reading.repeats.value_or(Repeats::keep_first);
  std::vector<std::size_t> dropped;
  const NamedTrajectory out{"merged", merged(files, repeats, dropped), {}};
  const bool had_covariances = std::ranges::any_of(
      files, [](const TrajectoryFile& file) { return !file.covariances.empty(); });
  if (had_covariances && out.file.covariances.empty()) {
    fmt::print(stderr,
               "loopbench: merge: covariances are removed, because not all files have them\n");
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (dropped[i] == 0) continue;
    fmt::print(stderr,
               "loopbench: {}: dropped {} with the stamp of a pose of another file\n",
               printable(all[i].name),
               counted(dropped[i], "pose"));
  }
  return write_all(a, {out});
}

int crop(const TrajArguments& a) {
  return write_changed(a, [&](NamedTrajectory& each) {
    const double origin = a.relative ? each.file.poses.front().stamp : 0.0;
    each.file = selected(each.file, within(each.file.poses, origin + a.start, origin + a.end));
    if (each.file.poses.empty()) throw InputError(each.name + ": has no poses in this time range");
  });
}

int split(const TrajArguments& a) {
  const bool is_automatic = a.parts == "auto";
  if (is_automatic && a.reference.empty()) {
    throw InputError("split: expected --ref FILE, or a file with the parts (--parts FILE)");
  }
  std::optional<NamedTrajectory> reference;
  if (!a.reference.empty()) reference = read_named(a.reference, a.reading);
  const Trajectory none;
  const Trajectory& truth = reference ? reference->file.poses : none;
  NamedTrajectories out;
  for (const NamedTrajectory& each : read_all_named(a.files, a.reading)) {
    for (NamedTrajectory& part : split_file(each, a.parts, truth, a.offset)) {
      out.push_back(std::move(part));
    }
  }
  return write_all(a, out);
}

int transform(const TrajArguments& a) {
  const std::string& given = a.left.empty() ? a.right : a.left;
  if (given.empty() && (a.invert || a.conventions == Conventions{})) {
    throw InputError(
        "transform: expected --left or --right (also for --invert), or any of --quaternion-order, "
        "--conjugate, --axes, --mirror, --scale, --stamp-scale, --invert-poses, --chain");
  }
  std::optional<Similarity> similarity;
  if (!given.empty()) similarity = read_similarity(given);
  if (a.invert) similarity = inverse(*similarity);
  const TransformSide right = a.propagate ? TransformSide::right_propagated : TransformSide::right;
  const TransformSide side = a.right.empty() ? TransformSide::left : right;
  return write_changed(a, [&](NamedTrajectory& each) {
    each.file = corrected(std::move(each.file), a.conventions);
    if (!similarity) return;
    const Trajectory before = each.file.poses;
    each.file.poses = transformed(before, *similarity, side);
    std::vector<Matrix6>& covariances = each.file.covariances;
    if (side == TransformSide::right_propagated) covariances.clear();
    if (side == TransformSide::right) displace(covariances, before, each.file.poses);
    if (side == TransformSide::left) rotate(covariances, similarity->pose, similarity->scale);
  });
}

int align_files(const TrajArguments& a) {
  const NamedTrajectory reference = read_named(a.reference, a.reading);
  std::vector<AlignedFile> aligned;
  const auto change = [&](NamedTrajectory& each) {
    const metrics::Paired pairs = paired(a, reference, each);
    const std::size_t count = pairs.reference.size();
    try {
      const metrics::Alignment fit =
          metrics::align(pairs.reference, pairs.estimate, a.align, a.align_first);
      each.file.poses = metrics::moved(fit, std::move(each.file.poses));
      rotate(each.file.covariances, fit.reference_from_estimate, fit.scale);
      const auto& [rotation, position] = fit.reference_from_estimate;
      const std::size_t used = a.align_first > 0 ? std::min(a.align_first, count) : count;
      aligned.push_back({a.reference, each.name, used, fit});
      if (!a.json) {
        fmt::print(stderr,
                   "{}: aligned with {}, scale {:.9g}, x,y,z,qx,qy,qz,qw = {:.9g}, {:.9g}\n",
                   printable(each.name),
                   counted(used, "pair"),
                   fit.scale,
                   fmt::join(position, ", "),
                   fmt::join(rotation.coeffs(), ", "));
      }
    } catch (const std::runtime_error& error) {
      throw InputError(each.name + ": " + error.what());
    }
    shift_stamps(each.file, a.offset);
  };
  const int exit_code = write_changed(a, change, &reference);
  if (a.json) fmt::print("{}", json(aligned));
  return exit_code;
}

int plot_files(const TrajArguments& a) {
  std::optional<NamedTrajectory> reference;
  if (!a.reference.empty()) reference = read_named(a.reference, a.reading);
  const NamedTrajectories all =
      read_all_named(a.files, a.reading, reference ? &*reference : nullptr);
  reject_standard_output("-o", a.out);
  if (!is_figure_name(a.out)) {
    throw InputError(a.out + ": expected a file name that ends in .svg, .pdf, .png or .pgf");
  }
  FigureData data = trajectory_figure(all, reference, a.panels, a.figures);
  data.figures.front().files = {a.out};
  draw({data});
  fmt::print("{}", printable(file_list(data.figures.front())));
  return kExitOk;
}

}  // namespace

void add_traj(CLI::App& app, int& exit_code) {
  CLI::App* traj = app.add_subcommand(
      "traj", "Inspect, convert and change trajectory files (TUM, KITTI, EuRoC, g2o, csv, bags)");
  traj->require_subcommand(1);
  declare_traj(*traj,
               {{"info", info},
                {"convert", convert},
                {"merge", merge_files},
                {"crop", crop},
                {"split", split},
                {"transform", transform},
                {"align", align_files},
                {"plot", plot_files}},
               exit_code);
}

}  // namespace loopbench::harness
