#include "harness/eval/recorded_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "datasets/core/covariance.hpp"
#include "datasets/core/fields.hpp"
#include "datasets/formats/covariance_columns.hpp"
#include "datasets/formats/text_formats.hpp"
#include "harness/eval/trajectory_selection.hpp"
#include "metrics/protocols/protocols.hpp"
#include "metrics/trajectory/position_only.hpp"

namespace loopbench::harness {
namespace {

Format reference_format(const EvalArguments& a) { return a.reference_format.value_or(a.format); }

/// Keeps the poses with these indices.
void keep(RecordedFile& file, const std::vector<std::size_t>& indices) {
  const auto keep_in = [&](auto& all) {
    if (all.empty()) return;
    std::remove_reference_t<decltype(all)> kept;
    for (const std::size_t i : indices) kept.push_back(all[i]);
    all = std::move(kept);
  };
  keep_in(file.poses);
  keep_in(file.matrices);
  keep_in(file.findings.covariances);
}

/// Converts poses and covariances to another body.
void change_body(RecordedFile& file,
                 Trajectory (*convert)(Trajectory, const ReferenceBody&),
                 const ReferenceBody& body) {
  const Trajectory before = file.findings.covariances.empty() ? Trajectory() : file.poses;
  file.poses = convert(std::move(file.poses), body);
  displace(file.findings.covariances, before, file.poses);
}

RecordedFile read_recorded(const std::string& file,
                           Format format,
                           const std::string& covariances,
                           const EvalArguments& a,
                           bool with_digits,
                           const std::optional<GeodeticOrigin>& origin = {}) {
  RecordedFile out;
  ReadOptions options;
  options.origin = origin;
  options.format = format == Format::automatic ? detect_format(file) : format;
  options.repeats = repeats_of(a);
  options.period = a.period.value_or(options.period);
  const bool is_kitti = options.format == Format::kitti;
  if (is_kitti && !a.times.empty()) options.times = a.times;
  options.positions = true;
  options.findings = &out.findings;
  out.poses = read_trajectory(file, options);
  if (out.poses.empty()) throw input_error(file, 0, "has no poses, expected at least one");
  if (options.format == Format::g2o || (is_kitti && !options.times)) {
    out.unstamped = file + ": is " + to_text(options.format);
  }
  if (is_kitti && with_digits) out.matrices = read_kitti_matrices(file);
  if (!covariances.empty()) {
    out.findings.covariances =
        read_covariance_file(covariances, out.poses, out.findings.assumed_axes);
  }
  // Bags contain zeros if nothing is known.
  const auto is_zero = [](const Matrix6& covariance) { return covariance.isZero(0.0); };
  if (std::ranges::all_of(out.findings.covariances, is_zero)) out.findings.covariances.clear();
  if (a.downsample) keep(out, evenly_spaced(out.poses.size(), *a.downsample));
  if (a.motion_filter.size() == 2) {
    keep(out, by_motion(out.poses, a.motion_filter[0], a.motion_filter[1]));
  }
  return out;
}

/// Whether any file has this format, by the arguments or its content.
bool has_poses_of(Format wanted, const EvalArguments& a, const std::vector<RecordedRun>& runs) {
  const auto is_wanted = [wanted](const std::string& file, Format format) {
    if (format != Format::automatic || !std::filesystem::is_regular_file(file)) {
      return format == wanted;
    }
    return detect_format(file) == wanted;
  };
  return std::ranges::any_of(runs, [&](const RecordedRun& run) {
    return is_wanted(run.reference, reference_format(a)) || is_wanted(run.estimate, a.format);
  });
}

}  // namespace

Repeats repeats_of(const EvalArguments& a) {
  if (a.repeats) return *a.repeats;
  const auto is_evo = [](const metrics::NamedProtocol& each) {
    return each.rules.association == metrics::Association::evo;
  };
  return std::ranges::all_of(protocols(a), is_evo) ? Repeats::keep_all : Repeats::refuse;
}

RecordedFile recorded_reference(const std::string& file, const EvalArguments& a, bool with_digits) {
  RecordedFile out =
      read_recorded(file, reference_format(a), a.reference_covariances, a, with_digits);
  if (a.start || a.end) {
    const EvaluatedRange range = evaluated_range(a);
    keep(out, within(out.poses, range.start, range.end));
  }
  if (out.poses.empty()) throw input_error(file, 0, "has no poses between --start and --end");
  const ReferenceBody body = reference_body(a);
  // The lever arm of a placeholder orientation would point into a wrong direction.
  const bool has_placeholders = has_offset(body) && metrics::is_position_only(out.poses);
  if (a.reference_positions || has_placeholders) {
    for (StampedPose& pose : out.poses) pose.world_from_body.rotation = no_rotation();
  }
  change_body(out, to_estimate_body, body);
  return out;
}

RecordedFile recorded_estimate(const std::string& file,
                               const EvalArguments& a,
                               bool with_digits,
                               const RecordedFile* reference) {
  const std::optional<GeodeticOrigin> none;
  RecordedFile out = read_recorded(
      file, a.format, a.covariances, a, with_digits, reference ? reference->findings.origin : none);
  const ReferenceBody body = reference_body(a);
  if (reference == nullptr || !lacks_rotations(reference->poses) || !has_offset(body)) return out;
  if (metrics::is_position_only(out.poses)) {
    throw InputError(file + ": --ref-body needs rotations, and neither file has any");
  }
  change_body(out, to_reference_body, body);
  return out;
}

std::vector<std::string> reading_notes(const ReadFindings& findings, const std::string& whose) {
  std::vector<std::string> out;
  if (findings.origin) out.push_back(whose + ": " + to_text(*findings.origin));
  if (findings.assumed_axes) {
    out.push_back(whose +
                  ": the convention of the covariances is assumed, and '#%TANGENT_CONVENTION "
                  "right_perturbation', left_perturbation or fixed_axes above the poses states it");
  }
  if (findings.without_fix > 0) {
    out.push_back(whose + ": " + std::to_string(findings.without_fix) + " rows have no fix");
  }
  return out;
}

Params reading_options(const EvalArguments& a) {
  const double period = a.period.value_or(ReadOptions{}.period);
  if (!(period > 0.0)) {
    throw OptionError("period", "period = " + to_text(period) + ": expected period > 0");
  }
  const Repeats repeats = repeats_of(a);
  Params out{{"format", to_text(a.format)},
             {"reference_format", to_text(reference_format(a))},
             {"repeats", repeats == Repeats::keep_all ? "keep_all" : to_text(repeats)},
             {"times", a.times},
             {"reference_body", a.reference_body.value_or("")},
             {"period", period}};
  if (!a.covariances.empty()) out["covariances"] = a.covariances;
  if (!a.reference_covariances.empty()) out["reference_covariances"] = a.reference_covariances;
  if (a.start) out["start"] = *a.start;
  if (a.end) out["end"] = *a.end;
  if (a.downsample) out["downsample"] = static_cast<std::int64_t>(*a.downsample);
  if (a.motion_filter.size() == 2) {
    out["motion_filter"] = fmt::format("{} {}", a.motion_filter[0], a.motion_filter[1]);
  }
  return out;
}

void check_stamp_options(const EvalArguments& a, const std::vector<RecordedRun>& runs) {
  const bool has_kitti = (!a.times.empty() || a.period) && has_poses_of(Format::kitti, a, runs);
  if (!a.times.empty() && !has_kitti) {
    throw InputError(a.times + ": is a times file, but no file has KITTI poses");
  }
  const bool has_unstamped = has_kitti && a.times.empty();
  if (a.period && !has_unstamped && !has_poses_of(Format::g2o, a, runs)) {
    throw InputError("--period " + to_text(*a.period) +
                     ": all files have stamps, expected KITTI poses without --times, or g2o");
  }
}

}  // namespace loopbench::harness
