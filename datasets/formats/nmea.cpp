#include "datasets/formats/nmea.hpp"

#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "datasets/columns/pose_rules.hpp"

namespace loopbench {
namespace {

constexpr double kSecondsOfDay = 86'400.0;

/// Fields of a sentence with a right checksum; the first is "$GPGGA".
std::vector<std::string_view> fields_of(const TextFile& file, const Line& line) {
  std::string_view text = line.text;
  const std::size_t star = text.find('*');
  if (star != text.npos) {
    unsigned char sum = 0;
    for (const char c : text.substr(1, star - 1)) sum ^= static_cast<unsigned char>(c);
    unsigned stated = 0;
    const std::string_view digits = text.substr(star + 1, 2);
    std::from_chars(digits.data(), digits.data() + digits.size(), stated, 16);
    if (stated != sum) {
      throw InvalidRow(
          file.error(line.number,
                     fmt::format("has checksum {:02X}, its characters have {:02X}", stated, sum)));
    }
    text = text.substr(0, star);
  }
  std::vector<std::string_view> out;
  while (true) {
    const std::size_t comma = std::min(text.find(','), text.size());
    out.push_back(text.substr(0, comma));
    if (comma == text.size()) return out;
    text.remove_prefix(comma + 1);
  }
}

std::optional<double> number_of(std::string_view text) {
  double value = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Of hhmmss.sss, the seconds since midnight.
std::optional<double> seconds_of_day(std::string_view text) {
  const auto number = number_of(text);
  if (!number) return std::nullopt;
  const double hours = std::floor(*number / 1e4), minutes = std::floor(*number / 100.0);
  return 3600.0 * hours + 60.0 * (minutes - 100.0 * hours) + *number - 100.0 * minutes;
}

/// Of ddmm.mmm and a hemisphere [deg].
std::optional<double> degrees_of(std::string_view text, std::string_view hemisphere) {
  const auto number = number_of(text);
  if (!number || hemisphere.size() != 1) return std::nullopt;
  const double whole = std::floor(*number / 100.0);
  const double degrees = whole + (*number - 100.0 * whole) / 60.0;
  return hemisphere == "S" || hemisphere == "W" ? -degrees : degrees;
}

/// Midnight of ddmmyy, in seconds since 1970.
std::optional<double> midnight_of(std::string_view text) {
  const auto number = number_of(text);
  if (!number || text.size() != 6) return std::nullopt;
  const auto all = static_cast<unsigned>(*number);
  const std::chrono::year_month_day date{std::chrono::year(2000 + static_cast<int>(all % 100)),
                                         std::chrono::month(all / 100 % 100),
                                         std::chrono::day(all / 10'000)};
  if (!date.ok()) return std::nullopt;
  return kSecondsOfDay *
         static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
}

struct NmeaFix {
  double time = 0.0;  ///< since midnight [s]
  Vector3 position = Vector3::Zero();
  std::size_t line = 0;
};

struct NmeaFile {
  std::vector<NmeaFix> of_gga, of_rmc;
  std::optional<double> midnight;  ///< of the first date
};

void read_gga(const std::vector<std::string_view>& fields, std::size_t line, NmeaFile& out) {
  if (fields.size() < 12 || fields[6] == "0") return;
  const auto time = seconds_of_day(fields[1]);
  const auto latitude = degrees_of(fields[2], fields[3]);
  const auto longitude = degrees_of(fields[4], fields[5]);
  const double height = number_of(fields[9]).value_or(0.0) + number_of(fields[11]).value_or(0.0);
  if (time && latitude && longitude)
    out.of_gga.push_back({*time, {*latitude, *longitude, height}, line});
}

void read_rmc(const std::vector<std::string_view>& fields, std::size_t line, NmeaFile& out) {
  if (fields.size() < 10) return;
  if (!out.midnight) out.midnight = midnight_of(fields[9]);
  if (fields[2] != "A") return;
  const auto time = seconds_of_day(fields[1]);
  const auto latitude = degrees_of(fields[3], fields[4]);
  const auto longitude = degrees_of(fields[5], fields[6]);
  if (time && latitude && longitude)
    out.of_rmc.push_back({*time, {*latitude, *longitude, 0.0}, line});
}

}  // namespace

bool is_nmea(const Line& line) {
  return line.text.size() > 7 && line.text[0] == '$' && line.text[6] == ',';
}

Trajectory read_nmea(TextFile& file, const ReadOptions& options) {
  NmeaFile all;
  std::size_t sentences = 0;
  for_each_row(file, options, [&](const Line& line) {
    if (!is_nmea(line)) return;
    const std::string_view kind = line.text.substr(3, 3);
    if (kind != "GGA" && kind != "RMC") return;
    ++sentences;
    const std::vector<std::string_view> fields = fields_of(file, line);
    kind == "GGA" ? read_gga(fields, line.number, all) : read_rmc(fields, line.number, all);
  });
  const bool has_gga = !all.of_gga.empty();
  const std::vector<NmeaFix>& fixes = has_gga ? all.of_gga : all.of_rmc;
  if (fixes.empty()) {
    throw file.error(
        0, fmt::format("has {} GGA and RMC sentences, expected some with a position", sentences));
  }
  if (!options.positions) {
    throw file.error(0,
                     "has positions without rotation (NMEA), which are accepted only as a "
                     "reference, and by eval, doctor and traj");
  }
  Trajectory out;
  StampOrder order(file, options, 0);
  double day = all.midnight.value_or(0.0), last = fixes.front().time;
  for (const NmeaFix& fix : fixes) {
    if (fix.time < last - 0.5 * kSecondsOfDay) day += kSecondsOfDay;
    last = fix.time;
    const double stamp = 1e-3 * std::round(1e3 * (day + fix.time));
    order.put(stamp, fmt::format("{:.3f}", stamp), fix.line, {no_rotation(), fix.position}, out);
  }
  file.repaired.units = {StampUnit::s};
  file.repaired.has_clear_unit = true;
  return local_positions(std::move(out), options, file.repaired);
}

}  // namespace loopbench
