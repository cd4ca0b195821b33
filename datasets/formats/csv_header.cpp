#include "datasets/formats/csv_header.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "datasets/formats/csv_names.hpp"

namespace loopbench {
namespace {

constexpr std::string_view kBlanks = " \t";

std::vector<std::string> header_names(std::string_view header) {
  std::vector<std::string_view> columns;
  split_columns(header, columns);
  const bool by_commas = header.find(',') != header.npos;
  std::vector<std::string> out;
  for (const std::string_view name : columns) {
    const bool is_unit = name.starts_with('[') || name.starts_with('(');
    if (!by_commas && is_unit && !out.empty()) {
      out.back() += name;
    } else {
      out.emplace_back(name);
    }
  }
  return out;
}

std::string shortened(const std::string& name) {
  constexpr std::size_t kMost = 40;
  return name.size() > kMost ? name.substr(0, kMost) + "..." : name;
}

struct PoseNames {
  std::vector<std::string> names;
  std::vector<std::optional<PoseColumn>> meanings;

  /// Columns of the header with this meaning and rank.
  std::vector<std::size_t> with(std::size_t column, NameRank rank) const {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < meanings.size(); ++i) {
      if (meanings[i] && meanings[i]->column == column && meanings[i]->rank == rank) {
        out.push_back(i);
      }
    }
    return out;
  }

  /// Columns of the lowest rank with this meaning.
  std::vector<std::size_t> best(std::size_t column) const {
    for (const NameRank rank :
         {NameRank::usual, NameRank::rare, NameRank::whole_seconds, NameRank::nanoseconds}) {
      if (auto out = with(column, rank); !out.empty()) return out;
    }
    return {};
  }

  std::string unknown() const {
    constexpr std::size_t kMost = 6;
    std::string out;
    std::size_t count = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (meanings[i] || names[i].empty()) continue;
      if (++count <= kMost) out += (count == 1 ? "" : ", ") + shortened(names[i]);
    }
    return out + (count > kMost ? ", ..." : "");
  }
};

/// Takes the first column as the time if it is the only one that is unknown.
void assume_time(PoseNames& all) {
  if (all.names.empty() || all.meanings[0]) return;
  if (std::ranges::count_if(all.meanings, [](const auto& it) { return !it; }) != 1 ||
      !all.best(0).empty())
    return;
  constexpr std::array kCounters{"id", "idx", "index", "frame", "frameid", "seq"};
  const std::string& name = all.names[0];
  NamedColumn first = named_column(name);
  const bool is_counter = std::ranges::count(kCounters, first.base) > 0;
  if (first.base.empty() || is_counter) return;
  if (const std::size_t at = name.rfind('_'); first.unit.empty() && at != name.npos) {
    const std::string suffix = plain_name(std::string_view(name).substr(at));
    if (time_exponent(suffix)) first.unit = suffix;
  }
  all.meanings[0] = time_column({"t", first.unit});
}

/// Columns of the upper triangle of the covariance by rows, as write_trajectory() names them; sets
/// `why_not` if some are missing.
std::vector<std::size_t> covariance_indices(const PoseNames& all,
                                            bool has_rotation,
                                            std::string& why_not) {
  constexpr std::array kAxes{"x", "y", "z", "roll", "pitch", "yaw"};
  const std::size_t axes = has_rotation ? kAxes.size() : 3;
  std::vector<std::size_t> out;
  std::string missing;
  for (std::size_t i = 0; i < axes; ++i) {
    for (std::size_t j = i; j < axes; ++j) {
      const std::string name = fmt::format("cov_{}_{}", kAxes[i], kAxes[j]);
      const auto found = std::ranges::find(all.names, name);
      if (found == all.names.end() && missing.empty()) missing = name;
      if (found != all.names.end()) {
        out.push_back(static_cast<std::size_t>(found - all.names.begin()));
      }
    }
  }
  if (!missing.empty() && !out.empty()) why_not = "has a header of a covariance without " + missing;
  return out;
}

/// Whether the header has latitude, longitude and height instead of x, y and z.
bool names_degrees(const PoseNames& all) {
  const auto names = [&](std::size_t column) { return !all.best(column).empty(); };
  return !names(1) && !names(2) && !names(3) && names(8);
}

/// Columns of the header that stand for x, y and z.
std::size_t position_column(const PoseNames& all, std::size_t axis) {
  return (names_degrees(all) ? 8 : 1) + axis;
}

std::string why_not_understood(const PoseNames& all, bool with_rotation) {
  constexpr const char* kAccepted =
      "expected time (t, timestamp, time_ns, secs with nsecs), position (x, tx, p_x, position.x) "
      "and quaternion (qw, q_w, orientation.w, or q0 q1 q2 q3 for w x y z)";
  constexpr std::array kOthers{"latitude", "longitude", "height"};
  std::string missing;
  for (std::size_t i = 0; i < (with_rotation ? kPoseColumns.size() : 4); ++i) {
    const std::size_t column = 1 <= i && i < 4 ? position_column(all, i - 1) : i;
    const char* const name = column < 8 ? kPoseColumns[column] : kOthers[column - 8];
    const std::vector<std::size_t> found = all.best(column);
    if (found.empty()) missing += (missing.empty() ? "" : ", ") + std::string(name);
    if (found.size() > 1) {
      return fmt::format("has a header with two columns for {}: {} and {}",
                         name,
                         shortened(all.names[found[0]]),
                         shortened(all.names[found[1]]));
    }
    if (!found.empty() && !all.meanings[found[0]]->wrong_unit.empty()) {
      return fmt::format("has a header with unit {} in '{}', expected {}",
                         shortened(all.meanings[found[0]]->wrong_unit),
                         shortened(all.names[found[0]]),
                         i == 0                       ? "s, ms, us or ns"
                         : column == 8 || column == 9 ? "deg"
                                                      : "m, cm or mm");
    }
  }
  if (missing.empty()) return "";
  const std::string unknown = all.unknown();
  return fmt::format("has a header without {}{}, {}",
                     missing,
                     unknown.empty() ? "" : " (unknown: " + unknown + ")",
                     kAccepted);
}

/// The column of nanoseconds after whole seconds. `why_not` is set if it has no such partner.
std::optional<std::size_t> nanoseconds_column(const PoseNames& all, std::string& why_not) {
  const std::size_t time = all.best(0).front();
  const std::vector<std::size_t> partners = all.with(0, NameRank::nanoseconds);
  if (all.meanings[time]->rank == NameRank::nanoseconds || partners.empty()) return std::nullopt;
  const bool is_split = all.meanings[time]->rank == NameRank::whole_seconds;
  if (!is_split && !all.with(0, NameRank::whole_seconds).empty())
    return std::nullopt;  // stated twice
  const bool is_nanoseconds = all.meanings[partners[0]]->time_exponent == -9;
  if (is_split && partners.size() == 1 && is_nanoseconds &&
      all.meanings[time]->time_exponent == 0) {
    return partners[0];
  }
  why_not = fmt::format("has a header with time in '{}' and '{}', expected one, or secs and nsecs",
                        shortened(all.names[time]),
                        shortened(all.names[partners[0]]));
  return std::nullopt;
}

}  // namespace

void split_columns(std::string_view text, std::vector<std::string_view>& out) {
  out.clear();
  const std::string_view separators = text.find(',') == text.npos ? kBlanks : ",";
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    if (text.empty()) return;
    const std::size_t closing = text.front() == '"' ? text.find('"', 1) : text.npos;
    const std::size_t begin = closing == text.npos ? 0 : closing;
    const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
    if (closing == text.npos) {
      const std::string_view column = text.substr(0, end);
      out.push_back(column.substr(0, column.find_last_not_of(kBlanks) + 1));
    } else {
      out.push_back(text.substr(1, closing - 1));
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

CsvHeader csv_header(std::string_view header) {
  constexpr std::string_view kTrajectopy = "fields ";  // its comment `#fields t,px,py,...`
  if (header.starts_with(kTrajectopy)) header.remove_prefix(kTrajectopy.size());
  PoseNames all;
  all.names = header_names(header);
  for (const std::string& name : all.names) all.meanings.push_back(pose_column(name));
  CsvHeader out;
  out.width = all.names.size();
  assume_time(all);
  out.names_time = !all.best(0).empty();
  for (std::size_t i = 1; i < kPoseColumns.size(); ++i) {
    if (!all.best(i).empty()) (i < 4 ? out.names_position : out.names_quaternion) = true;
  }
  out.why_not = why_not_understood(all, true);
  CsvColumns columns;
  columns.has_rotation = out.names_quaternion || out.why_not.empty();
  if (!out.why_not.empty() && columns.has_rotation) return out;
  if (!why_not_understood(all, columns.has_rotation).empty()) return out;
  columns.is_geodetic = names_degrees(all);
  out.names_position |= columns.is_geodetic;
  const std::vector<std::size_t> fix = all.best(11);
  if (columns.is_geodetic && !fix.empty()) columns.fix = fix.front();
  columns.width = out.width;
  std::string why_not_split;
  columns.nanoseconds = nanoseconds_column(all, why_not_split);
  if (!why_not_split.empty()) {
    out.why_not = why_not_split;
    return out;
  }
  for (std::size_t i = 0; i < (columns.has_rotation ? columns.index.size() : 4); ++i) {
    const bool is_position = 1 <= i && i < 4;
    columns.index[i] = all.best(is_position ? position_column(all, i - 1) : i).front();
  }
  columns.covariance = covariance_indices(all, columns.has_rotation, why_not_split);
  if (!why_not_split.empty()) {
    out.why_not = why_not_split;
    return out;
  }
  columns.time_exponent = all.meanings[columns.index[0]]->time_exponent;
  for (std::size_t i = 0; i < columns.per_metre.size(); ++i) {
    columns.per_metre[i] = all.meanings[columns.index[1 + i]]->per_metre;
  }
  out.columns = columns;
  return out;
}

}  // namespace loopbench
