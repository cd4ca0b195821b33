#include "datasets/formats/tum.hpp"

#include "datasets/columns/covariance_columns.hpp"
#include "datasets/columns/parts.hpp"
#include "datasets/columns/pose_rules.hpp"
#include "datasets/columns/stamp_unit.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/formats/detect_format.hpp"
#include "datasets/formats/format_registry.hpp"
#include "datasets/formats/known_layouts.hpp"
#include "datasets/formats/written_rows.hpp"

namespace loopbench {
namespace {

constexpr std::array kTumColumns{"stamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"};

/// Whether a line has a ninth column, the number of a node, as RTAB-Map exports it: the stamp has
/// decimals, unlike that of EuRoC, and columns 5 to 8 are a unit quaternion.
bool has_node_id(const TextFile& file, const Line& line) {
  const bool is_in_seconds = Columns(file, line).word().find('.') != std::string_view::npos;
  return is_in_seconds && count_columns(file, line) == 9 &&
         is_unit_square(square_of_columns(file, line, 4, 4));
}

struct TumColumns {
  std::size_t pose = kTumColumns.size();
  std::optional<CovarianceColumns> covariance;
  bool has_id = false;  ///< a ninth column with the number of a node, as RTAB-Map exports it
  int exponent = 0;     ///< unit of the stamps
};

TumColumns tum_columns(TextFile& file, const ReadOptions& options) {
  const Line first = first_line(file);
  TumColumns out;
  if (options.positions && count_columns(file, first) == 4) out.pose = 4;
  out.covariance = covariance_columns(file, first, kTumColumns.size());
  out.has_id = !out.covariance && has_node_id(file, first);
  out.exponent = stamp_exponent(file, 0, options);
  return out;
}

InputError wrong_row(const TextFile& file,
                     const Line& line,
                     bool positions,
                     const TumColumns& layout) {
  if (positions && layout.pose == 4) {
    return wrong_columns(file, line, Format::tum, "4 as in the first row: stamp x y z");
  }
  if (layout.covariance) {
    const std::size_t width = layout.pose + layout.covariance->count();
    return wrong_columns(file,
                         line,
                         Format::tum,
                         std::to_string(width) + " as in the first row: a pose and its covariance");
  }
  if (count_columns(file, line) == 4 && !line.unterminated) {
    return file.error(line.number,
                      std::string("has 4 columns (stamp x y z?): ") +
                          (positions ? "the first row has a rotation"
                                     : "positions without rotation are accepted only as a "
                                       "reference, and by eval, doctor and traj") +
                          ", expected 8: stamp tx ty tz qx qy qz qw");
  }
  if (layout.has_id) {
    return wrong_columns(file, line, Format::tum, "9 as in the first row: a pose and an id");
  }
  return wrong_columns(file, line, Format::tum, "8: stamp tx ty tz qx qy qz qw");
}

Trajectory read_tum_part(TextFile& file, const ReadOptions& options, const TumColumns& layout) {
  Trajectory out;
  const bool positions = options.positions;
  out.reserve(file.estimated_lines(first_line(file)));
  StampOrder order(file, options, layout.exponent);
  std::array<double, kTumColumns.size()> v{};
  for_each_row(file, options, [&](const Line& line) {
    Columns columns(file, line);
    const std::string_view stamp = columns.peek();
    for (std::size_t i = 0; i < layout.pose; ++i) {
      if (columns.done()) throw wrong_row(file, line, positions, layout);
      v[i] = columns.number(kTumColumns[i]);
    }
    if (layout.covariance) {
      if (count_columns(file, line) != layout.pose + layout.covariance->count()) {
        throw wrong_row(file, line, positions, layout);
      }
    } else if (layout.has_id) {
      if (columns.done()) throw wrong_row(file, line, positions, layout);
      columns.integer("id");
      if (!columns.done()) throw wrong_row(file, line, positions, layout);
    } else if (!columns.done()) {
      throw wrong_row(file, line, positions, layout);
    }
    if (layout.exponent != 0) v[0] = read_stamp(stamp, v[0], layout.exponent).seconds;
    const Rotation rotation = rotation_of_row(file, line, {v[7], v[4], v[5], v[6]}, out, options);
    const Pose pose{rotation, {v[1], v[2], v[3]}};
    std::optional<Matrix6> covariance;
    if (layout.covariance) {
      covariance = read_covariance(file, line, columns, *layout.covariance, pose);
    }
    order.put(v[0], stamp, line.number, pose, out);
    if (covariance) put_covariance(file, *covariance, out.size(), options.repeats);
  });
  return out;
}

bool is_tum(const TextFile& file, const Line& line) {
  if (!stamp_number(Columns(file, line).word())) return false;
  const std::size_t count = count_columns(file, line);
  return count == 8 || count == 4 || count == 29 || count == 44 || has_node_id(file, line);
}

Trajectory read_tum(TextFile& file, const ReadOptions& options) {
  const TumColumns layout = tum_columns(file, options);
  file.repaired.assumed_axes = layout.covariance && !layout.covariance->is_stated;
  return joined(read_parallel(
      file,
      [&](TextFile& part) { return read_tum_part(part, options, layout); },
      [&](const Trajectory& a, const Trajectory& b) { return follows(a, b, options.sort); }));
}

TextWriter text_of_tum(const TrajectoryFile& file, const std::string&) {
  return tum_text(file, {});
}

}  // namespace

TextWriter tum_text(const TrajectoryFile& file, const std::vector<std::string>& comments) {
  TextWriter out;
  for (const std::string& comment : comments) out.comment(comment);
  const bool is_uncertain = has_covariances(file, Format::tum);
  if (is_uncertain) out.word("#%TANGENT_CONVENTION fixed_axes").end_line();
  for (std::size_t i = 0; i < file.poses.size(); ++i) {
    write_row(out, file, i);
    if (is_uncertain) {
      for (const double value : file.covariances[i].reshaped()) out.number(value);  // symmetric
    }
    out.end_line();
  }
  return out;
}

FormatEntry tum_format() {
  return {.format = Format::tum,
          .guess = is_tum,
          .read = read_tum,
          .write = text_of_tum,
          .contents = {.positions = true, .covariances = true}};
}

}  // namespace loopbench
