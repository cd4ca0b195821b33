#include "datasets/columns/csv_names.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

namespace loopbench {
namespace {

/// Names of columns in lower case, letters and digits only.
struct Spelling {
  std::string_view stems;    ///< see is_one_of()
  std::string_view letters;  ///< the last letter of the name: of `first` and the roles after it
  Role first;
  NameRank rank = NameRank::usual;
};
constexpr std::string_view kRotations = "q|quat|quaternion|rot|qrs|*orientation|*rotation";
constexpr std::array kSpellings{
    Spelling{"q", "0123", Role::qw, NameRank::rare},
    Spelling{kRotations, "wxyz", Role::qw},
    Spelling{kRotations, "ijk", Role::qx, NameRank::rare},
    Spelling{"ori|r", "wxyz", Role::qw, NameRank::rare},
    Spelling{"|t|p|pos|prsr|trans|*position|*translation", "xyz", Role::x},
    Spelling{"rvec|rotvec|rotationvector|rodrigues|axisangle", "xyz", Role::vector_x},
    Spelling{"east|easting", "", Role::x, NameRank::rare},
    Spelling{"north|northing", "", Role::y, NameRank::rare},
    Spelling{"lat|*latitude", "", Role::latitude},
    Spelling{"lon|lng|long|*longitude", "", Role::longitude},
    Spelling{"alt|h|height|*altitude", "", Role::height},
    Spelling{"*statusstatus", "", Role::fix},  // of a NavSatFix
    Spelling{"roll", "", Role::roll},
    Spelling{"pitch", "", Role::pitch},
    Spelling{"yaw|theta|heading", "", Role::yaw},
};
constexpr std::string_view kUsualStamps = "t|time|times|stamp|timestamp|timestamps";
constexpr std::string_view kRareStamps = "epoch|*headerstamp|ts|stamps|gpstime";
constexpr std::string_view kStampsWithUnit =
    "|t|time|stamp|timestamp|epoch|*headerstamp|trackingtimestamp";
constexpr std::string_view kDegreeUnits = "|deg|degree|degrees|\u00b0";
constexpr std::string_view kRadianUnits = "|rad|radian|radians";
constexpr std::array<std::pair<std::string_view, double>, 3> kPerMetre{
    {{"|m|meter|meters|metre|metres", 1.0}, {"cm", 100.0}, {"mm", 1000.0}}};
constexpr std::array<std::pair<std::string_view, int>, 4> kTimeExponents{
    {{"s|sec|secs|second|seconds", 0},
     {"ms|msec|msecs|millisecond|milliseconds", -3},
     {"us|usec|usecs|microsecond|microseconds|\u00b5s|\u03bcs", -6},  // micro sign, Greek mu
     {"ns|nsec|nsecs|nanosec|nanosecs|nanosecond|nanoseconds", -9}}};

/// Whether `names`, separated by |, contain the name; * stands for any beginning.
bool is_one_of(std::string_view name, std::string_view names) {
  while (true) {
    const std::size_t end = std::min(names.find('|'), names.size());
    const std::string_view known = names.substr(0, end);
    if (known.starts_with('*') ? name.ends_with(known.substr(1)) : name == known) return true;
    if (end == names.size()) return false;
    names.remove_prefix(end + 1);
  }
}

template <class T, std::size_t N>
std::optional<T> unit_value(std::string_view unit,
                            const std::array<std::pair<std::string_view, T>, N>& units) {
  for (const auto& [names, value] : units) {
    if (is_one_of(unit, names)) return value;
  }
  return std::nullopt;
}

struct NamedColumn {
  std::string base;  ///< lower case, letters and digits only: "p_x [m]" -> "px"
  std::string unit;  ///< in brackets: "m"
};

/// Lower case, letters and digits only.
std::string plain_name(std::string_view name) {
  std::string out;
  for (const char c : name) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalnum(letter) != 0) out += static_cast<char>(std::tolower(letter));
  }
  return out;
}

NamedColumn named_column(std::string_view name) {
  const std::size_t bracket = std::min(name.find_first_of("[("), name.size());
  NamedColumn out{plain_name(name.substr(0, bracket)), {}};
  if (bracket == name.size()) return out;
  name.remove_prefix(bracket + 1);
  for (const char c : name.substr(0, name.find_first_of("])"))) {
    if (c != ' ') out.unit += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (out.base == "q" && is_one_of(out.unit, "0|1|2|3")) out = {"q" + out.unit, {}};
  if (out.base.ends_with("position") && is_one_of(out.unit, "0|1|2")) {  // of PX4
    out = {out.base + "xyz" [out.unit.front() - '0'], {}};
  }
  return out;
}

std::optional<PoseColumn> time_column(const NamedColumn& name) {
  const std::string_view base = name.base;
  PoseColumn out{Role::time, NameRank::rare};
  if (is_one_of(base, kUsualStamps)) {
    out.rank = NameRank::usual;
  } else if (base == "utime") {
    out.time_exponent = -6;  // by convention, as in LCM
  } else if (!is_one_of(base, kRareStamps)) {
    if (base.ends_with("second")) return std::nullopt;
    std::size_t begin = 0;  // of the longest unit that ends the name: "stampnsecs" -> "nsecs"
    while (begin < base.size() && !unit_value(base.substr(begin), kTimeExponents)) ++begin;
    const std::string_view stem = base.substr(0, begin), unit = base.substr(begin);
    if (unit.empty() || !is_one_of(stem, kStampsWithUnit)) return std::nullopt;
    out.time_exponent = unit_value(unit, kTimeExponents);
    const bool is_part = stem.empty() || unit.find("sec") != unit.npos;
    if (is_part && out.time_exponent == 0) out.rank = NameRank::whole_seconds;
    if (is_part && out.time_exponent == -9) out.rank = NameRank::nanoseconds;
  }
  if (!name.unit.empty()) {
    out.time_exponent = unit_value(name.unit, kTimeExponents);
    if (!out.time_exponent) out.wrong_unit = name.unit;
  }
  return out;
}

/// A unit of angles and the order of axes behind it: "deg,zyx" or "zyx".
std::pair<std::string, std::string> split_order(const std::string& unit) {
  constexpr std::size_t kAxes = 3;
  if (unit.size() < kAxes) return {unit, ""};
  const std::string order = unit.substr(unit.size() - kAxes);
  std::string axes = order;
  std::ranges::sort(axes);
  if (axes != "xyz") return {unit, ""};
  std::string rest = unit.substr(0, unit.size() - kAxes);
  while (rest.ends_with(',') || rest.ends_with(';')) rest.pop_back();
  return {rest, order};
}

/// By kSpellings.
std::optional<PoseColumn> spelled_column(const NamedColumn& name) {
  for (const auto& [stems, letters, first, rank] : kSpellings) {
    std::string_view stem = name.base;
    std::size_t letter = 0;
    if (!letters.empty()) {
      letter = letters.find(stem.back());
      stem.remove_suffix(1);
    }
    if (letter == letters.npos || !is_one_of(stem, stems)) continue;
    PoseColumn out{after(first, letter), rank};
    if (first == Role::x || first == Role::height) {
      const auto per_metre = unit_value(name.unit, kPerMetre);
      out.per_metre = per_metre.value_or(1.0);
      if (!per_metre) out.wrong_unit = name.unit;
    } else if (first == Role::latitude || first == Role::longitude) {
      if (!is_one_of(name.unit, kDegreeUnits)) out.wrong_unit = name.unit;
    } else if (first >= Role::vector_x) {
      const bool is_vector = first < Role::roll;
      const auto [unit, order] = split_order(name.unit);
      if (!is_vector) out.order = order;
      if (is_one_of(unit, kRadianUnits)) return out;
      out.is_in_degrees = !is_vector && is_one_of(unit, kDegreeUnits);
      if (!out.is_in_degrees) out.wrong_unit = name.unit;
    }
    return out;
  }
  return std::nullopt;
}

/// Removes names of frames, words in capitals in the middle: "p_WS_W_x" -> "p_x".
std::string without_frames(std::string_view name) {
  std::string out(name);
  for (std::size_t begin = out.find('_'); begin != out.npos;) {
    const std::size_t end = out.find('_', begin + 1);
    if (end == out.npos) break;
    const bool is_frame = std::all_of(out.begin() + static_cast<std::ptrdiff_t>(begin) + 1,
                                      out.begin() + static_cast<std::ptrdiff_t>(end),
                                      [](unsigned char c) { return std::isupper(c) != 0; });
    if (is_frame && end > begin + 1) {
      out.erase(begin, end - begin);
    } else {
      begin = end;
    }
  }
  return out;
}

}  // namespace

std::optional<PoseColumn> pose_column(std::string_view full_name) {
  const std::string name = without_frames(full_name);
  const NamedColumn full = named_column(name);
  if (full.base.empty()) return std::nullopt;
  if (const auto time = time_column(full)) return time;
  if (const auto column = spelled_column(full)) return column;
  const std::size_t suffix = name.rfind('_');
  if (suffix == name.npos || !full.unit.empty()) return std::nullopt;
  // tx_world_device, qw_odometry_device, as of Project Aria.
  if (const std::size_t frames = name.find('_'); frames == 2 && name.ends_with("_device")) {
    return spelled_column(named_column(name.substr(0, frames)));
  }
  const NamedColumn stem{plain_name(name.substr(0, suffix)), plain_name(name.substr(suffix))};
  if (stem.base.empty()) return std::nullopt;
  const bool is_length = unit_value(stem.unit, kPerMetre).has_value();
  const bool is_angle = is_one_of(stem.unit, "deg|rad");
  const auto column = is_length || is_angle ? spelled_column(stem) : std::nullopt;
  const bool is_position = column && Role::x <= column->role && column->role <= Role::z;
  const bool is_rotation = column && Role::roll <= column->role;
  return (is_length && is_position) || (is_angle && is_rotation) ? column : std::nullopt;
}

bool names_frames(std::string_view name) {
  constexpr std::string_view kFrames =
      "|id|idx|index|seq|frame|frames|frameid|frameidx|frameindex|frameno|framenumber|kf|kfid|"
      "keyframe|keyframeid|image|imageid|imagename|imagefile|img|imgname|filename|file|name";
  return is_one_of(plain_name(name), kFrames);
}

bool is_message_stamp(std::string_view name) {
  return plain_name(name).find("headerstamp") != std::string::npos;
}

PoseColumn assumed_time(std::string_view name) {
  NamedColumn column = named_column(name);
  if (const std::size_t at = name.rfind('_'); column.unit.empty() && at != name.npos) {
    const std::string suffix = plain_name(name.substr(at));
    if (unit_value(suffix, kTimeExponents)) column.unit = suffix;
  }
  return *time_column({"t", column.unit});
}

}  // namespace loopbench
