#include "datasets/formats/nmea.hpp"

#include <fmt/format.h>

#include <algorithm>
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
  if (!number || !(0.0 <= *number && *number < 240'000.0)) return std::nullopt;
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
  const auto is_digit = [](char c) { return '0' <= c && c <= '9'; };
  const auto number = number_of(text);
  if (!number || text.size() != 6 || !std::ranges::all_of(text, is_digit)) return std::nullopt;
  const auto all = static_cast<unsigned>(*number);
  const std::chrono::year_month_day date{std::chrono::year(2000 + static_cast<int>(all % 100)),
                                         std::chrono::month(all / 100 % 100),
                                         std::chrono::day(all / 10'000)};
  if (!date.ok()) return std::nullopt;
  return kSecondsOfDay *
         static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
}

struct NmeaFix {
  double midnight = 0.0;  ///< of its day [s]
  double time = 0.0;      ///< since then [s]
  Vector3 position = Vector3::Zero();
  std::size_t line = 0;
};

/// Fixes of one kind of sentence.
struct NmeaFixes {
  std::vector<NmeaFix> fixes;
  std::size_t without = 0;  ///< sentences without a position
};

/// Sentences in the order of the file. Before the first date, days count from 0 on.
class NmeaSentences {
 public:
  NmeaFixes of_gga, of_rmc;

  explicit NmeaSentences(const TextFile& file) : file_(file) {}

  void read_gga(const std::vector<std::string_view>& fields, std::size_t line) {
    if (fields.size() < 12) return;
    const auto time = seconds_of_day(fields[1]);
    const auto latitude = degrees_of(fields[2], fields[3]);
    const auto longitude = degrees_of(fields[4], fields[5]);
    if (fields[6] == "0" || !time || !latitude || !longitude) {
      ++of_gga.without;
      return;
    }
    const double height = number_of(fields[9]).value_or(0.0) + number_of(fields[11]).value_or(0.0);
    pass(*time);
    add({*latitude, *longitude, height}, line, of_gga);
  }

  void read_rmc(const std::vector<std::string_view>& fields, std::size_t line) {
    if (fields.size() < 10) return;
    const auto time = seconds_of_day(fields[1]);
    const auto midnight = midnight_of(fields[9]);
    const bool is_valid = fields[2] == "A";
    // The date of a receiver without a fix is that of its clock, better than none.
    const bool has_date = time && midnight && (is_valid || !is_dated_);
    if (time && (is_valid || has_date)) pass(*time);
    if (has_date) set_date(*midnight);
    const auto latitude = degrees_of(fields[3], fields[4]);
    const auto longitude = degrees_of(fields[5], fields[6]);
    if (!is_valid || !time || !latitude || !longitude) {
      ++of_rmc.without;
      return;
    }
    add({*latitude, *longitude, 0.0}, line, of_rmc);
  }

 private:
  /// A time of day that is much earlier than the last one is that of the next day.
  void pass(double time) {
    if (time < time_ - 0.5 * kSecondsOfDay) midnight_ += kSecondsOfDay;
    time_ = time;
  }

  void set_date(double midnight) {
    for (NmeaFixes* all : {&of_gga, &of_rmc}) {
      if (is_dated_) break;
      for (NmeaFix& fix : all->fixes) fix.midnight += midnight - midnight_;
    }
    midnight_ = midnight;
    is_dated_ = true;
  }

  void add(const Vector3& position, std::size_t line, NmeaFixes& to) const {
    require_degrees(file_, line, position);
    to.fixes.push_back({midnight_, time_, position, line});
  }

  const TextFile& file_;
  double midnight_ = 0.0, time_ = 0.0;  ///< of the last sentence
  bool is_dated_ = false;
};

}  // namespace

bool is_nmea(const Line& line) {
  const bool is_proprietary = line.text.starts_with("$P") && line.text.find(',') != line.text.npos;
  return is_proprietary || (line.text.size() > 7 && line.text[0] == '$' && line.text[6] == ',');
}

Trajectory read_nmea(TextFile& file, const ReadOptions& options) {
  NmeaSentences all(file);
  std::size_t sentences = 0;
  for_each_row(file, options, [&](const Line& line) {
    if (!is_nmea(line) || line.text[1] == 'P') return;  // $PGRMC is a receiver's own
    const std::string_view kind = line.text.substr(3, 3);
    if (kind != "GGA" && kind != "RMC") return;
    ++sentences;
    const std::vector<std::string_view> fields = fields_of(file, line);
    kind == "GGA" ? all.read_gga(fields, line.number) : all.read_rmc(fields, line.number);
  });
  const auto& [fixes, without] = all.of_gga.fixes.empty() ? all.of_rmc : all.of_gga;
  if (fixes.empty()) {
    throw file.error(
        0, fmt::format("has {} GGA and RMC sentences, expected some with a position", sentences));
  }
  if (!options.positions) {
    throw file.error(0,
                     "has positions without rotation (NMEA), which are accepted only as a "
                     "reference, and by eval, doctor and traj");
  }
  file.repaired.without_fix = without;
  Trajectory out;
  StampOrder order(file, options, 0);
  for (const NmeaFix& fix : fixes) {
    const double stamp = 1e-3 * std::round(1e3 * (fix.midnight + fix.time));
    order.put(stamp, fmt::format("{:.3f}", stamp), fix.line, {no_rotation(), fix.position}, out);
  }
  file.repaired.units = {StampUnit::s};
  file.repaired.has_clear_unit = true;
  return local_positions(std::move(out), options, file.repaired);
}

}  // namespace loopbench
