#include "harness/commands/eval/evaluated_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "datasets/columns/covariance_columns.hpp"
#include "datasets/columns/stamp_unit.hpp"
#include "datasets/core/covariance.hpp"
#include "datasets/core/fields.hpp"
#include "datasets/formats/kitti.hpp"
#include "harness/commands/eval/common_rows.hpp"
#include "harness/commands/files/trajectory_selection.hpp"
#include "metrics/protocols/protocols.hpp"
#include "metrics/trajectory/position_only.hpp"

namespace loopbench::harness {
namespace {

Format reference_format(const EvalArguments& a) { return a.reference_format.value_or(a.format); }

/// Converts poses and covariances to another body.
void change_body(EvaluatedFile& file,
                 Trajectory (*convert)(Trajectory, const ReferenceBody&),
                 const ReferenceBody& body) {
  const Trajectory before = file.findings.covariances.empty() ? Trajectory() : file.poses;
  file.poses = convert(std::move(file.poses), body);
  displace(file.findings.covariances, before, file.poses);
}

/// The arguments' offset of the estimate's clock [s]; 0 if protocols differ.
double offset_of(const EvalArguments& a) {
  const std::vector<metrics::NamedProtocol> all = protocols(a);
  const double first = all.front().rules.offset;
  const bool is_common =
      std::ranges::all_of(all, [&](const auto& each) { return each.rules.offset == first; });
  return is_common ? first : 0.0;
}

/// The rows of the poses, if some were dropped and the others kept their order.
std::vector<std::size_t> rows_of(const EvaluatedFile& file) {
  const ReadFindings& found = file.findings;
  if (found.dropped.empty() || found.unsorted > 0) return {};
  std::vector<std::size_t> out = rows_without(found.rows, found.dropped);
  if (out.size() != file.poses.size()) out.clear();  // some had repeated stamps
  return out;
}

/// The other file of a pair.
struct Partner {
  std::string name;  ///< empty: none
  Format format = Format::automatic;
  bool is_reference = false;
};

/// Whether the stated times are those of this file: it has no stamps, or has numbers of frames, and
/// its partner has stamps.
bool gets_times(const std::string& file, Format format, const Partner& partner) {
  if (takes_times(file, format)) return true;
  if (!can_take_times(file, format)) return false;
  if (!std::filesystem::is_regular_file(partner.name)) return true;
  const bool is_detected = partner.format == Format::automatic;
  return !takes_times(partner.name, is_detected ? detect_format(partner.name) : partner.format);
}

EvaluatedFile read_estimate_file(const std::string& file,
                                 Format format,
                                 const std::string& covariances,
                                 const EvalArguments& a,
                                 bool with_digits,
                                 const Partner& partner,
                                 const EvaluatedFile* other) {
  EvaluatedFile out;
  ReadOptions options = read_options(a);
  if (other) options.origin = other->findings.origin;
  options.format = format == Format::automatic ? detect_format(file) : format;
  options.repeats = repeats_of(a);
  if (!a.times.empty() && gets_times(file, options.format, partner)) options.times = a.times;
  options.findings = &out.findings;
  out.poses = read_trajectory(file, options);
  if (other) {
    const double offset = offset_of(a);
    options.stamp_unit =
        better_unit(out.poses, out.findings, other->poses, partner.is_reference ? offset : -offset);
    if (options.stamp_unit != StampUnit::automatic) {
      out.findings = {};
      out.poses = read_trajectory(file, options);
    }
    require_clear_unit(file, out.findings);
  }
  if (out.poses.empty()) throw input_error(file, 0, "has no poses, expected at least one");
  out.clock = {file, out.findings.clock, out.poses.size() + out.findings.invalid};
  out.rows = rows_of(out);
  const bool has_changed_rows = a.sort || a.drop_invalid;
  if (options.format == Format::kitti && with_digits && !has_changed_rows) {
    out.matrices = read_kitti_matrices(file);
  }
  if (!covariances.empty()) {
    out.findings.covariances =
        read_covariance_file(covariances, out.poses, out.findings.assumed_axes);
  }
  // Bags contain zeros if nothing is known.
  const auto is_zero = [](const Matrix6& covariance) { return covariance.isZero(0.0); };
  if (std::ranges::all_of(out.findings.covariances, is_zero)) out.findings.covariances.clear();
  if (a.downsample || a.motion_filter.size() == 2) out.rows.clear();
  if (a.downsample) keep_poses(out, evenly_spaced(out.poses.size(), *a.downsample));
  if (a.motion_filter.size() == 2) {
    keep_poses(out, by_motion(out.poses, a.motion_filter[0], a.motion_filter[1]));
  }
  return out;
}

/// Whether any file has poses without stamps, or `with_numbers` numbers of frames.
bool has_unstamped(bool with_numbers,
                   const EvalArguments& a,
                   const std::vector<EvaluatedRun>& runs) {
  const auto is_wanted = [with_numbers](const std::string& file, Format format) {
    const bool is_readable = std::filesystem::is_regular_file(file);
    if (format == Format::automatic && is_readable) format = detect_format(file);
    if (!is_readable) return format == Format::kitti || format == Format::g2o;
    return takes_times(file, format) || (with_numbers && can_take_times(file, format));
  };
  return std::ranges::any_of(runs, [&](const EvaluatedRun& run) {
    return is_wanted(run.reference, reference_format(a)) || is_wanted(run.estimate, a.format);
  });
}

}  // namespace

void keep_poses(EvaluatedFile& file, const std::vector<std::size_t>& indices) {
  const auto keep_in = [&](auto& all) {
    if (all.empty()) return;
    std::remove_reference_t<decltype(all)> kept;
    for (const std::size_t i : indices) kept.push_back(all[i]);
    all = std::move(kept);
  };
  keep_in(file.poses);
  keep_in(file.matrices);
  keep_in(file.findings.covariances);
  keep_in(file.rows);
}

Repeats repeats_of(const EvalArguments& a) {
  if (a.repeats) return *a.repeats;
  const auto accepts_equal_stamps = [](const metrics::NamedProtocol& each) {
    return each.rules.association == metrics::Association::evo ||
           each.rules.association == metrics::Association::index;
  };
  return std::ranges::all_of(protocols(a), accepts_equal_stamps) ? Repeats::keep_all
                                                                 : Repeats::refuse;
}

EvaluatedFile evaluated_reference(const std::string& file,
                                  const EvalArguments& a,
                                  bool with_digits,
                                  const std::string& estimate) {
  const Partner own_partner{estimate, a.format, false};
  EvaluatedFile out = read_estimate_file(
      file, reference_format(a), a.reference_covariances, a, with_digits, own_partner, nullptr);
  if (out.findings.units.size() > 1 && std::filesystem::is_regular_file(estimate)) {
    try {
      const Partner reference{file, reference_format(a), true};
      const EvaluatedFile other =
          read_estimate_file(estimate, a.format, "", a, false, reference, nullptr);
      const std::string& covariances = a.reference_covariances;
      if (other.findings.has_clear_unit) {  // otherwise its unit is decided by the reference
        out = read_estimate_file(
            file, reference_format(a), covariances, a, with_digits, own_partner, &other);
      }
    } catch (const InputError&) {  // reported when the estimate is evaluated
    }
  }
  require_clear_unit(file, out.findings);
  if (a.start || a.end) {
    const EvaluatedRange range = evaluated_range(a);
    if (out.rows.empty()) out.rows = row_numbers(out);
    keep_poses(out, within(out.poses, range.start, range.end));
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

EvaluatedFile evaluated_estimate(const std::string& file,
                                 const EvalArguments& a,
                                 bool with_digits,
                                 const EvaluatedFile* reference) {
  const Partner partner{
      reference ? reference->clock.name : std::string(), reference_format(a), true};
  EvaluatedFile out =
      read_estimate_file(file, a.format, a.covariances, a, with_digits, partner, reference);
  const ReferenceBody body = reference_body(a);
  if (reference == nullptr || !lacks_rotations(reference->poses) || !has_offset(body)) return out;
  if (metrics::is_position_only(out.poses)) {
    throw InputError(file + ": --ref-body needs rotations, and neither file has any");
  }
  change_body(out, to_reference_body, body);
  return out;
}

std::vector<Note> reading_notes(const ReadFindings& findings, const std::string& whose) {
  std::vector<Note> out;
  for (const auto& [kind, value] : row_changes(findings)) {
    const auto first = static_cast<int>(NoteKind::dropped_rows);
    out.push_back({.kind = static_cast<NoteKind>(first + static_cast<int>(kind)),
                   .subject = whose,
                   .numbers = {{"value", value}}});
  }
  std::vector<std::string> words = reading_choices(findings);
  if (findings.origin) words.push_back(to_text(*findings.origin));
  if (findings.assumed_axes) {
    words.emplace_back(
        "the convention of the covariances is assumed, and '#%TANGENT_CONVENTION "
        "right_perturbation', left_perturbation or fixed_axes above the poses states it");
  }
  if (findings.without_fix > 0) {
    words.push_back(std::to_string(findings.without_fix) + " rows have no fix");
  }
  for (const std::string& each : words) out.push_back({.subject = whose, .detail = each});
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
  if (a.sort) out["sort"] = true;
  if (a.drop_invalid) out["drop_invalid"] = true;
  if (a.stamp_unit != StampUnit::automatic) out["stamp_unit"] = to_text(a.stamp_unit);
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

void check_stamp_options(const EvalArguments& a, const std::vector<EvaluatedRun>& runs) {
  if (!a.times.empty() && !has_unstamped(true, a, runs)) {
    throw InputError(a.times + ": is a times file, but all files have stamps");
  }
  if (a.period && (!a.times.empty() || !has_unstamped(false, a, runs))) {
    throw InputError("--period " + to_text(*a.period) +
                     ": all files have stamps, expected KITTI poses without --times, or g2o");
  }
}

}  // namespace loopbench::harness
