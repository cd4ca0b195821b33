#include "datasets/formats/csv_names.hpp"

#include <algorithm>
#include <cctype>

namespace loopbench {
namespace {

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> known) {
  return std::ranges::count(known, name) > 0;
}

std::optional<double> units_per_metre(std::string_view unit) {
  if (is_one_of(unit, {"", "m", "meter", "meters", "metre", "metres"})) return 1.0;
  if (unit == "cm") return 100.0;
  if (unit == "mm") return 1000.0;
  return std::nullopt;
}

bool is_stamp(std::string_view base) {
  return is_one_of(base, {"t", "time", "stamp", "timestamp", "epoch"}) ||
         base.ends_with("headerstamp");
}

/// The unit that ends a name: "stampnsecs" -> "nsecs".
std::string_view unit_suffix(std::string_view base) {
  for (const std::string_view unit : {"nanoseconds",
                                      "microseconds",
                                      "milliseconds",
                                      "seconds",
                                      "nanosecs",
                                      "nanosec",
                                      "nsecs",
                                      "nsec",
                                      "usecs",
                                      "usec",
                                      "msecs",
                                      "msec",
                                      "secs",
                                      "sec",
                                      "ns",
                                      "us",
                                      "ms",
                                      "s"}) {
    if (base.ends_with(unit)) return unit;
  }
  return {};
}

/// x, y, z: 0, 1, 2; w: 3.
std::optional<std::size_t> axis_of(char letter) {
  const std::size_t axis = std::string_view("xyzw").find(letter);
  return axis == std::string_view::npos ? std::nullopt : std::optional(axis);
}

std::optional<PoseColumn> quaternion_column(std::string_view base) {
  constexpr std::size_t kFirst = 4;
  if (base.size() == 2 && base[0] == 'q' && '0' <= base[1] && base[1] <= '3') {
    return PoseColumn{kFirst + static_cast<std::size_t>(base[1] - '0'), NameRank::rare};
  }
  const std::string_view stem = base.substr(0, base.size() - 1);
  const std::size_t imaginary = std::string_view("ijk").find(base.back());
  const bool has_letter = imaginary != std::string_view::npos;
  const auto axis = has_letter ? std::optional(imaginary) : axis_of(base.back());
  if (!axis) return std::nullopt;
  const std::size_t column = *axis == 3 ? kFirst : kFirst + 1 + *axis;
  const bool is_usual = is_one_of(stem, {"q", "quat", "quaternion", "rot", "qrs"}) ||
                        stem.ends_with("orientation") || stem.ends_with("rotation");
  if (is_usual) return PoseColumn{column, has_letter ? NameRank::rare : NameRank::usual};
  if (!has_letter && is_one_of(stem, {"ori", "r"})) return PoseColumn{column, NameRank::rare};
  return std::nullopt;
}

std::optional<PoseColumn> position_column(const NamedColumn& name) {
  const auto axis = axis_of(name.base.back());
  const std::string_view stem = std::string_view(name.base).substr(0, name.base.size() - 1);
  const bool is_position = is_one_of(stem, {"", "t", "p", "pos", "prsr", "trans"}) ||
                           stem.ends_with("position") || stem.ends_with("translation");
  if (!axis || *axis == 3 || !is_position) return std::nullopt;
  const auto per_metre = units_per_metre(name.unit);
  return PoseColumn{
      1 + *axis, NameRank::usual, {}, per_metre.value_or(1.0), per_metre ? "" : name.unit};
}

/// Latitude, longitude [deg] and ellipsoidal height: also fields of NavSatFix, with the status.
std::optional<PoseColumn> geodetic_column(const NamedColumn& name) {
  constexpr std::size_t kFirst = 8;
  const std::string_view base = name.base;
  const auto angle = [&](std::size_t column) {
    const bool is_degrees = is_one_of(name.unit, {"", "deg", "degree", "degrees", "\u00b0"});
    return PoseColumn{column, NameRank::usual, {}, 1.0, is_degrees ? "" : name.unit};
  };
  if (base == "lat" || base.ends_with("latitude")) return angle(kFirst);
  if (is_one_of(base, {"lon", "lng", "long"}) || base.ends_with("longitude")) {
    return angle(kFirst + 1);
  }
  if (is_one_of(base, {"alt", "h", "height"}) || base.ends_with("altitude")) {
    const auto per_metre = units_per_metre(name.unit);
    return PoseColumn{
        kFirst + 2, NameRank::usual, {}, per_metre.value_or(1.0), per_metre ? "" : name.unit};
  }
  if (base.ends_with("statusstatus")) return PoseColumn{kFirst + 3};
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
  if (out.base == "q" && is_one_of(out.unit, {"0", "1", "2", "3"})) out = {"q" + out.unit, {}};
  return out;
}

std::optional<int> time_exponent(std::string_view unit) {
  if (is_one_of(unit, {"s", "sec", "secs", "second", "seconds"})) return 0;
  if (is_one_of(unit, {"ms", "msec", "msecs", "millisecond", "milliseconds"})) return -3;
  if (is_one_of(unit, {"us", "usec", "usecs", "microsecond", "microseconds"})) return -6;
  if (is_one_of(unit, {"\u00b5s", "\u03bcs"})) return -6;  // micro sign, Greek mu
  if (is_one_of(unit, {"ns", "nsec", "nsecs", "nanosec", "nanosecs"})) return -9;
  if (is_one_of(unit, {"nanosecond", "nanoseconds"})) return -9;
  return std::nullopt;
}

std::optional<PoseColumn> time_column(const NamedColumn& name) {
  const std::string_view base = name.base;
  const std::string_view suffix = unit_suffix(base);
  const std::string_view stem = base.substr(0, base.size() - suffix.size());
  PoseColumn out;
  if (is_one_of(base, {"t", "time", "times", "stamp", "timestamp", "timestamps"})) {
    out.rank = NameRank::usual;
  } else if (base == "utime") {
    out.rank = NameRank::rare;
    out.time_exponent = -6;  // by convention, as in LCM
  } else if (is_stamp(base) || is_one_of(base, {"ts", "stamps"})) {
    out.rank = NameRank::rare;
  } else if (!suffix.empty() && (stem.empty() || is_stamp(stem))) {
    out.time_exponent = time_exponent(suffix);
    const bool is_part = stem.empty() || suffix.find("sec") != suffix.npos;
    out.rank = is_part && out.time_exponent == 0    ? NameRank::whole_seconds
               : is_part && out.time_exponent == -9 ? NameRank::nanoseconds
                                                    : NameRank::rare;
  } else {
    return std::nullopt;
  }
  if (!name.unit.empty()) {
    out.time_exponent = time_exponent(name.unit);
    if (!out.time_exponent) out.wrong_unit = name.unit;
  }
  return out;
}

std::optional<PoseColumn> pose_column(std::string_view name) {
  const std::string bare = without_frames(name);
  name = bare;
  const NamedColumn full = named_column(name);
  if (full.base.empty()) return std::nullopt;
  if (const auto time = time_column(full)) return time;
  if (const auto rotation = quaternion_column(full.base)) return rotation;
  if (const auto position = position_column(full)) return position;
  if (const auto geodetic = geodetic_column(full)) return geodetic;
  const std::size_t suffix = name.rfind('_');
  if (suffix == name.npos || !full.unit.empty()) return std::nullopt;
  const NamedColumn stem{plain_name(name.substr(0, suffix)), plain_name(name.substr(suffix))};
  if (stem.base.empty() || !units_per_metre(stem.unit)) return std::nullopt;
  return position_column(stem);
}

}  // namespace loopbench
