#include "datasets/columns/csv_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numbers>

#include "datasets/columns/covariance_columns.hpp"
#include "datasets/columns/csv_names.hpp"
#include "datasets/columns/pose_names.hpp"

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

/// Columns with covariance_names(); sets `why_not` if some are missing.
std::vector<std::size_t> covariance_indices(const PoseNames& all,
                                            bool has_rotation,
                                            std::string& why_not) {
  std::vector<std::size_t> out;
  std::string missing;
  for (const std::string& name : covariance_names(has_rotation)) {
    const auto found = std::ranges::find(all.names, name);
    if (found == all.names.end()) {
      if (missing.empty()) missing = name;
    } else {
      out.push_back(static_cast<std::size_t>(found - all.names.begin()));
    }
  }
  if (!missing.empty() && !out.empty()) why_not = "has a header of a covariance without " + missing;
  return out;
}

std::string why_not_understood(const PoseNames& all, bool with_rotation) {
  constexpr const char* kAccepted =
      "expected time (t, timestamp, time_ns, secs with nsecs), position (x, tx, p_x, position.x) "
      "and quaternion (qw, q_w, orientation.w, or q0 q1 q2 q3 for w x y z)";
  std::string missing;
  for (const Role role : all.roles(with_rotation)) {
    const char* const name = kRoleNames[static_cast<std::size_t>(role)];
    const std::vector<std::size_t> found = all.best(role);
    if (found.empty()) {
      missing += (missing.empty() ? "" : ", ") + std::string(name);
      continue;
    }
    if (found.size() > 1) {
      return fmt::format("has a header with two columns for {}: {} and {}",
                         name,
                         shortened(all.names[found[0]]),
                         shortened(all.names[found[1]]));
    }
    if (const std::string& wrong = all.meaning(found[0]).wrong_unit; !wrong.empty()) {
      std::string accepted = "m, cm or mm";
      if (role == Role::time) accepted = "s, ms, us or ns";
      if (role == Role::latitude || role == Role::longitude) accepted = "deg";
      if (role >= Role::roll) accepted = "rad or deg, and an order such as zyx";
      if (Role::vector_x <= role && role <= Role::vector_z) accepted = "rad";
      return fmt::format("has a header with unit {} in '{}', expected {}",
                         shortened(wrong),
                         shortened(all.names[found[0]]),
                         accepted);
    }
  }
  if (missing.empty()) return "";
  const std::string unknown = all.unknown();
  return fmt::format("has a header without {}{}, {}",
                     missing,
                     unknown.empty() ? "" : " (unknown: " + unknown + ")",
                     kAccepted);
}

/// "zyx, xyz" if roll, pitch and yaw state different orders; empty: they do not.
std::string contradicting_orders(const PoseNames& all) {
  std::string first;
  for (const Role role : {Role::roll, Role::pitch, Role::yaw}) {
    if (!all.has(role)) continue;
    const std::string& order = all.meaning(all.best(role).front()).order;
    if (order.empty() || order == first) continue;
    if (!first.empty()) return first + ", " + order;
    first = order;
  }
  return "";
}

/// The column of nanoseconds after whole seconds. `why_not` is set if it has no such partner.
std::optional<std::size_t> nanoseconds_column(const PoseNames& all, std::string& why_not) {
  const std::size_t time = all.best(Role::time).front();
  const std::vector<std::size_t> partners = all.with(Role::time, NameRank::nanoseconds);
  const NameRank rank = all.meaning(time).rank;
  if (rank == NameRank::nanoseconds || partners.empty()) return std::nullopt;
  const bool is_split = rank == NameRank::whole_seconds;
  if (!is_split && !all.with(Role::time, NameRank::whole_seconds).empty())
    return std::nullopt;  // stated twice
  const bool is_nanoseconds = all.meaning(partners[0]).time_exponent == -9;
  if (is_split && partners.size() == 1 && is_nanoseconds && all.meaning(time).time_exponent == 0)
    return partners[0];
  why_not = fmt::format("has a header with time in '{}' and '{}', expected one, or secs and nsecs",
                        shortened(all.names[time]),
                        shortened(all.names[partners[0]]));
  return std::nullopt;
}

/// Takes a column of another name as the time if none is named so.
void assume_time(PoseNames& all, CsvColumns& columns) {
  if (all.has(Role::time) || all.names.empty()) return;
  const auto named = std::ranges::find_if(all.names, names_frames);
  const bool lacks_one = std::ranges::count_if(all.meanings, std::logical_not{}) == 1;
  columns.names_frames = named != all.names.end();
  if (!columns.names_frames && (!lacks_one || all.meanings[0])) return;
  const auto i = columns.names_frames ? named - all.names.begin() : 0;
  auto& meaning = all.meanings[static_cast<std::size_t>(i)];
  if (!meaning) meaning = assumed_time(all.names[static_cast<std::size_t>(i)]);
}

/// Drops other times beside stamps of messages, and returns their names.
std::string prefer_message_stamps(PoseNames& all) {
  const auto is_time = [&](std::size_t i) {
    return all.meanings[i] && all.meanings[i]->role == Role::time;
  };
  bool has_any = false;
  for (std::size_t i = 0; i < all.names.size(); ++i) {
    has_any |= is_time(i) && is_message_stamp(all.names[i]);
  }
  std::string out;
  for (std::size_t i = 0; has_any && i < all.names.size(); ++i) {
    if (!is_time(i) || is_message_stamp(all.names[i])) continue;
    out += (out.empty() ? "" : ", ") + shortened(all.names[i]);
    all.meanings[i].reset();
  }
  return out;
}

void set_indices(const PoseNames& all, CsvColumns& columns) {
  std::size_t count = 0;
  for (const Role role : all.roles(columns.has_rotation)) {
    const std::size_t found = all.best(role).front();
    if (role < Role::vector_x) {
      columns.index[count++] = found;
      continue;
    }
    columns.angles.push_back(found);
    columns.is_vector = role < Role::roll;
    if (all.meaning(found).is_in_degrees) columns.per_radian = 180.0 / std::numbers::pi;
    if (!all.meaning(found).order.empty()) columns.order = all.meaning(found).order;
  }
  columns.lacks_z = columns.angles.size() == 1;
  if (columns.lacks_z) columns.index[3] = columns.index[2];  // not read
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
  if (const auto colon = header.find(": "); colon != header.npos) {  // "format: t x y z ..."
    if (header.find_first_of(" \t,", header.find_first_not_of(kBlanks)) > colon)
      header.remove_prefix(colon + 1);
  }
  const std::size_t bracket = header.find_first_of("[(");  // the only one in "[t, x, y, z]"
  if (bracket == header.find_first_not_of(kBlanks) && bracket == header.find_last_of("[(")) {
    header = header.substr(bracket + 1, header.find_first_of("])") - bracket - 1);
  }
  PoseNames all;
  all.names = header_names(header);
  CsvColumns columns;
  columns.has_more = !all.names.empty() && all.names.back().starts_with('*');
  if (columns.has_more) all.names.pop_back();
  for (const std::string& name : all.names) all.meanings.push_back(pose_column(name));
  CsvHeader out;
  out.width = all.names.size();
  assume_time(all, columns);
  const std::string other_times = prefer_message_stamps(all);
  out.names_time = all.has(Role::time);
  out.names_position = all.has_any(Role::x, 3);
  out.names_quaternion = all.has_any(Role::qw, 4);
  out.why_not = why_not_understood(all, true);
  const std::vector<Role> angles = all.angles();
  columns.has_rotation = out.names_quaternion || !angles.empty();
  if (!why_not_understood(all, columns.has_rotation).empty()) return out;
  columns.is_geodetic = all.is_geodetic();
  out.names_position |= columns.is_geodetic;
  if (columns.is_geodetic && all.has(Role::fix)) columns.fix = all.best(Role::fix).front();
  columns.width = out.width;
  std::string why_not;
  columns.nanoseconds = nanoseconds_column(all, why_not);
  if (why_not.empty()) columns.covariance = covariance_indices(all, columns.has_rotation, why_not);
  if (!why_not.empty()) {
    out.why_not = why_not;
    return out;
  }
  if (const std::string orders = contradicting_orders(all); !orders.empty()) {
    out.why_not = "has a header with different orders of angles: " + orders;
    return out;
  }
  set_indices(all, columns);
  columns.time_exponent = all.meaning(columns.index[0]).time_exponent;
  for (std::size_t i = 0; i < columns.per_metre.size(); ++i) {
    columns.per_metre[i] = all.meaning(columns.index[1 + i]).per_metre;
  }
  columns.names = all.names;
  const bool has_quaternion = columns.has_rotation && angles.empty();
  std::vector<std::size_t> used(columns.index.begin(),
                                columns.index.begin() + (has_quaternion ? 8 : 4));
  used.insert(used.end(), columns.angles.begin(), columns.angles.end());
  used.insert(used.end(), columns.covariance.begin(), columns.covariance.end());
  for (const auto& index : {columns.nanoseconds, columns.fix}) {
    if (index) used.push_back(*index);
  }
  columns.ignored = all.unknown(used);
  if (!other_times.empty()) {
    columns.time_column = all.names[columns.index[0]] + ", not " + other_times;
  }
  out.columns = columns;
  return out;
}

}  // namespace loopbench
