#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/columns/columns.hpp"
#include "datasets/columns/pose_rules.hpp"
#include "datasets/columns/stamp_unit.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/core/fields.hpp"
#include "datasets/formats/csv.hpp"
#include "datasets/formats/detect_format.hpp"
#include "datasets/formats/format_registry.hpp"
#include "datasets/formats/nmea.hpp"
#include "datasets/formats/times.hpp"
#include "datasets/formats/trajectory_file.hpp"

namespace loopbench {
namespace {

/// Rejects options that do not fit, then reads a text file.
TrajectoryFile read_text_file(const std::filesystem::path& path, const ReadOptions& options) {
  TextFile file(path);
  file.skip_header();
  const Format format = options.format == Format::automatic ? detect_format(file) : options.format;
  const FormatEntry& entry = entry_of(format);
  const bool has_none = entry.takes_times != nullptr && entry.takes_times(file);
  ReadOptions own = options;
  if (options.times && !has_none) {
    if (!can_be_frame_numbers(file, time_column(file, format))) {
      throw file.error(0, "has format " + to_text(format) + " with stamps, expected no times file");
    }
    own.stamp_unit = StampUnit::s;
  }
  TrajectoryFile out{.poses = entry.read(file, own), .format = format};
  ReadFindings& findings = file.repaired;
  if (options.times && !has_none) findings.clock = Clock::ids;
  if (findings.clock != Clock::stamps && !out.poses.empty()) {
    set_stamps(file.name(), options, findings, out.poses);
  }
  out.has_stamps = findings.clock == Clock::stamps;
  out.covariances = std::move(findings.covariances);
  findings.covariances.clear();
  if (options.findings) *options.findings = std::move(findings);
  return out;
}

/// The reader of a file that is not text; null: it is text.
const FormatEntry* file_format(const std::filesystem::path& path, Format stated) {
  if (names_bag(path.string())) return &entry_of(Format::bag);
  const FormatEntry* const found = detect_file(path);
  if (stated == Format::automatic || (found != nullptr && found->format == stated)) return found;
  const FormatEntry& entry = entry_of(stated);
  return entry.read_file == nullptr ? nullptr : &entry;
}

/// Exact stamps of the poses in `file`, in order; empty if one is not a number of nanoseconds.
std::vector<std::int64_t> exact_stamps(const std::filesystem::path& path,
                                       const TrajectoryFile& file,
                                       const ReadOptions& options) {
  constexpr double kRounding = 1e-6;  // of large stamps as doubles [s]
  TextFile text(path);
  text.skip_header();
  if (is_nmea(first_line(text))) return {};
  const auto csv = file.format == Format::csv ? csv_columns(text) : std::nullopt;
  const int exponent = csv ? csv_exponent(text, *csv, options) : stamp_exponent(text, 0, options);
  const auto stamp_of = [&](const Line& line) {
    Columns columns(text, line);
    return csv ? csv_stamp(text, line, *csv, exponent) : next_stamp(columns, exponent);
  };
  std::vector<std::int64_t> out;
  for (Line line; text.next(line) && out.size() < file.poses.size();) {
    ReadStamp stamp;
    try {
      stamp = stamp_of(line);
    } catch (const InvalidRow&) {
      continue;  // dropped
    }
    if (!stamp.exact) return {};
    // A repeated stamp belongs to the pose that was kept.
    const bool is_repeated = !out.empty() && out.back() == *stamp.exact &&
                             options.repeats != Repeats::keep_all && !options.sort;
    const bool is_next = std::abs(stamp.seconds - file.poses[out.size()].stamp) < kRounding;
    if (is_next && !is_repeated) out.push_back(*stamp.exact);
  }
  if (out.size() != file.poses.size()) out.clear();
  return out;
}

/// Sorts by stamp and applies `repeats`. Throws InputError. O(n log n).
void sort_rows(TrajectoryFile& file, const std::string& name, const ReadOptions& options) {
  if (!options.sort) return;
  std::vector<std::size_t> order(file.poses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto stamp = [&](std::size_t i) { return file.poses[i].stamp; };
  std::ranges::stable_sort(order, {}, stamp);
  std::vector<std::size_t> kept;
  Trajectory sorted;
  std::size_t moved = 0, repeated = 0, agreeing = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && order[k] < order[k - 1]) ++moved;
    const bool repeats = !kept.empty() && stamp(order[k]) == stamp(kept.back()) &&
                         options.repeats != Repeats::keep_all;
    const bool agrees = repeats && options.repeats == Repeats::refuse &&
                        agrees_with_last(sorted, file.poses[order[k]].world_from_body);
    agreeing += agrees ? 1 : 0;
    if (repeats && !agrees && options.repeats == Repeats::refuse) {
      throw InputError(name + ": stamp " + to_text(stamp(order[k])) +
                       " is in two rows with different poses, expected different stamps "
                       "(--repeats keep_first or keep_last, or repeats: in a config)");
    }
    repeated += repeats && !agrees ? 1 : 0;
    if (repeats && options.repeats == Repeats::keep_last) kept.back() = order[k];
    if (repeats) continue;
    kept.push_back(order[k]);
    sorted.push_back(file.poses[order[k]]);
  }
  if (kept.size() < file.poses.size() || moved > 0) file = selected(file, kept);
  if (options.findings == nullptr) return;
  options.findings->unsorted = moved;
  options.findings->repeated += repeated;
  options.findings->agreeing += agreeing;
}

void check_period(const ReadOptions& options) {
  if (GreaterThan{0.0}.holds(options.period)) return;
  throw OptionError("period", "period = " + to_text(options.period) + ": expected period > 0");
}

}  // namespace

namespace {

std::string scales_text(const MatrixScales& scales) {
  constexpr double kEqual = 1e-4;
  const bool is_common = scales.largest - scales.least <= kEqual * scales.largest;
  return fmt::format(
      "matrices of {} rows have a scale of {:.5g}{}, which is removed from the rotations; "
      "positions "
      "are as in the file",
      scales.rows,
      scales.least,
      is_common ? "" : fmt::format(" to {:.5g}", scales.largest));
}

}  // namespace

std::vector<RowChange> row_changes(const ReadFindings& findings) {
  using enum RowChange::Kind;
  std::vector<RowChange> out{{dropped_rows, static_cast<double>(findings.invalid)},
                             {sorted_rows, static_cast<double>(findings.unsorted)},
                             {repeated_stamps, static_cast<double>(findings.agreeing)},
                             {normalised_rotations, findings.off_orthonormal}};
  std::erase_if(out, [](const RowChange& each) { return !(each.value > 0.0); });
  return out;
}

std::string to_text(const RowChange& change) {
  switch (change.kind) {
    case RowChange::Kind::dropped_rows:
      return fmt::format("invalid rows dropped: {:.0f}", change.value);
    case RowChange::Kind::sorted_rows:
      return fmt::format("sorted {:.0f} {} out of order",
                         change.value,
                         change.value == 1.0 ? "row that was" : "rows that were");
    case RowChange::Kind::repeated_stamps:
      return fmt::format("{:.0f} repeated stamps with agreeing poses, of which the first is kept",
                         change.value);
    case RowChange::Kind::normalised_rotations:
      return fmt::format(
          "rotation matrices are normalised, they deviate from orthonormal by up to {:.2g}",
          change.value);
  }
  return "";
}

std::vector<std::string> reading_choices(const ReadFindings& findings) {
  std::vector<std::string> out;
  const auto note = [&](bool is_found, const std::string& text) {
    if (is_found) out.push_back(text);
  };
  const StampUnit unit = findings.units.front();
  note(findings.scales.rows > 0, scales_text(findings.scales));
  note(unit == StampUnit::ms || unit == StampUnit::us, "stamps are read in " + to_text(unit));
  note(findings.opengl_axes,
       "camera axes are converted from those of OpenGL (y up, z back) to y down, z ahead");
  note(findings.angles == 1, "planar poses x, y and heading");
  note(findings.angles == 3, "rotations are Rz(yaw) Ry(pitch) Rx(roll)");
  note(!findings.time_column.empty(), "time is " + findings.time_column);
  note(!findings.ignored_columns.empty(), "columns that are not read: " + findings.ignored_columns);
  return out;
}

std::vector<std::string> reading_notes(const ReadFindings& findings) {
  std::vector<std::string> out;
  for (const RowChange& each : row_changes(findings)) out.push_back(to_text(each));
  std::ranges::move(reading_choices(findings), std::back_inserter(out));
  return out;
}

Trajectory read_trajectory(const std::filesystem::path& path, const ReadOptions& options) {
  check_period(options);
  const FormatEntry* const other = file_format(path, options.format);
  TrajectoryFile out = other ? other->read_file(path, options) : read_text_file(path, options);
  sort_rows(out, path.string(), options);
  if (options.findings) options.findings->covariances = std::move(out.covariances);
  return std::move(out.poses);
}

TrajectoryFile read_trajectory_file(const std::filesystem::path& path, const ReadOptions& options) {
  check_period(options);
  if (const FormatEntry* const other = file_format(path, options.format)) {
    TrajectoryFile out = other->read_file(path, options);
    if (out.nanoseconds.empty()) sort_rows(out, path.string(), options);
    return out;
  }
  TrajectoryFile out = read_text_file(path, options);
  if (out.has_stamps && !options.times) out.nanoseconds = exact_stamps(path, out, options);
  sort_rows(out, path.string(), options);
  return out;
}

TrajectoryFile selected(const TrajectoryFile& file, const std::vector<std::size_t>& indices) {
  TrajectoryFile out{.poses = {}, .format = file.format, .has_stamps = file.has_stamps};
  for (const std::size_t i : indices) {
    out.poses.push_back(file.poses[i]);
    if (!file.nanoseconds.empty()) out.nanoseconds.push_back(file.nanoseconds[i]);
    if (!file.covariances.empty()) out.covariances.push_back(file.covariances[i]);
  }
  return out;
}

}  // namespace loopbench
