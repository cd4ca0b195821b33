#include "datasets/columns/stamp_unit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "datasets/columns/csv_header.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/core/fields.hpp"
#include "datasets/core/upper_median.hpp"

namespace loopbench {
namespace {

constexpr std::array kUnits{StampUnit::s, StampUnit::ms, StampUnit::us, StampUnit::ns};

/// The first stamps of a file.
struct SampledStamps {
  std::string first;
  double size = 0.0, interval = 0.0;           ///< largest; median of those that are not 0
  bool are_whole = true, are_integers = true;  ///< 12.0 is whole, 1.6e18 is an integer, too
};

SampledStamps sampled(const TextFile& file, std::size_t column) {
  constexpr std::size_t kMost = 60;
  SampledStamps out;
  TextFile reopened = file.reopened();
  std::vector<std::string_view> row;
  std::vector<double> intervals;
  double last = 0.0;
  std::size_t count = 0;
  for (Line line; count < kMost && reopened.next(line);) {
    split_columns(line.text, row);
    if (row.size() <= column) continue;
    const std::string_view word = row[column];
    const double value = stamp_number(word).value_or(HUGE_VAL);
    if (!std::isfinite(value)) continue;
    if (++count == 1) out.first = word;
    if (count > 1 && value != last) intervals.push_back(std::abs(value - last));
    last = value;
    out.size = std::max(out.size, std::abs(value));
    out.are_whole &= value == std::floor(value);
    out.are_integers &= word.find('.') == word.npos || word.find_first_of("eE") != word.npos;
  }
  if (!intervals.empty()) out.interval = upper_median(intervals);
  return out;
}

constexpr int kCertain = 5;

/// How well a unit fits; negative: not at all.
int fit(StampUnit unit, const SampledStamps& stamps) {
  constexpr double kLatest = 4.1e9, kEarliest = 6.3e8;   // 2099 and 1990 [s]
  constexpr double kShortest = 2e-5, kLongest = 200.0;   // possible intervals [s]
  constexpr double kUsual = 1e-3, kMostUsual = 2.5;      // [s]
  constexpr double kMostSeconds = 1000.0, kSmall = 1e4;  // interval and time of whole numbers [s]
  const double factor = std::pow(10.0, exponent_of(unit));
  const double time = stamps.size * factor, step = stamps.interval * factor;
  if (time > kLatest) return -1;
  if (unit == StampUnit::s) {
    if (stamps.are_whole && step >= kMostSeconds && time >= kSmall) return -1;
    return time >= kEarliest ? kCertain : 4;
  }
  if (step != 0.0 && (step < kShortest || step > kLongest)) return -1;
  if (time >= kEarliest) return 3;
  // A clock that starts at 0 has decimals only in seconds.
  if (kUsual <= step && step <= kMostUsual) return 2;
  return step == 0.0 ? -1 : 1;
}

}  // namespace

int exponent_of(StampUnit unit) {
  if (unit == StampUnit::automatic) return 0;
  return -3 * (static_cast<int>(unit) - static_cast<int>(StampUnit::s));
}

FittingUnits fitting_units(const TextFile& file, std::size_t column) {
  const SampledStamps stamps = sampled(file, column);
  if (stamps.first.empty()) return {};
  const auto fit_of = [&](StampUnit unit) { return fit(unit, stamps); };
  FittingUnits out{.units = {}};
  std::ranges::copy_if(
      kUnits, std::back_inserter(out.units), [&](StampUnit unit) { return fit_of(unit) >= 0; });
  std::ranges::stable_sort(out.units, std::greater{}, fit_of);
  const bool are_keys = stamps.size > 4.1e18 && stamps.size < 9.2e18;
  if (out.units.empty() && are_keys) {
    throw file.error(
        0,
        "stamp " + stamps.first +
            " is in 2100 or later, perhaps the key of a pose in GTSAM: expected its time");
  }
  if (out.units.empty()) out.units = {stamps.size >= 1e16 ? StampUnit::ns : StampUnit::s};
  const bool is_decimal = !stamps.are_whole && fit_of(StampUnit::s) >= 0;
  if (is_decimal) out.units = {StampUnit::s};
  if (fit_of(out.units.front()) == kCertain) out.units.resize(1);
  out.is_clear = out.units.size() < 2 || fit_of(out.units[0]) > fit_of(out.units[1]);
  return out;
}

int stamp_exponent(const TextFile& file, std::size_t column, const ReadOptions& options) {
  if (options.stamp_unit != StampUnit::automatic) {
    file.repaired.units = {options.stamp_unit};
  } else {
    const FittingUnits found = fitting_units(file, column);
    file.repaired.units = found.units;
    file.repaired.has_clear_unit = found.is_clear;
  }
  return exponent_of(file.repaired.units.front());
}

namespace {

bool are_small_and_whole(const SampledStamps& stamps) {
  constexpr double kMost = 1e7, kLargestStep = 50.0;
  return !stamps.first.empty() && stamps.are_whole && stamps.size < kMost &&
         stamps.interval <= kLargestStep;
}

}  // namespace

bool has_frame_numbers(const TextFile& file, std::size_t column) {
  const SampledStamps stamps = sampled(file, column);
  return stamps.are_integers && are_small_and_whole(stamps);
}

bool can_be_frame_numbers(const TextFile& file, std::size_t column) {
  return are_small_and_whole(sampled(file, column));
}

StampUnit better_unit(const Trajectory& own,
                      const ReadFindings& findings,
                      const Trajectory& other,
                      double offset) {
  constexpr double kClearly = 5.0;
  if (findings.units.size() < 2 || own.empty() || other.empty()) return StampUnit::automatic;
  const int used = exponent_of(findings.units.front());
  double best = 0.0, before = 0.0;
  StampUnit out = StampUnit::automatic;
  for (const StampUnit unit : findings.units) {
    const double factor = std::pow(10.0, exponent_of(unit) - used);
    const double begin = own.front().stamp * factor + offset;
    const double end = own.back().stamp * factor + offset;
    const double common = std::min(end, other.back().stamp) - std::max(begin, other.front().stamp);
    const double longer = std::max(end - begin, other.back().stamp - other.front().stamp);
    const double share = longer > 0.0 ? std::max(0.0, common / longer) : 0.0;
    if (unit == findings.units.front()) before = share;
    if (share > best) out = unit;
    best = std::max(best, share);
  }
  if (offset != 0.0 && before > 0.0) return StampUnit::automatic;
  const bool is_better = best > (findings.has_clear_unit ? kClearly * before : 0.0);
  return is_better ? out : StampUnit::automatic;
}

void require_clear_unit(const std::string& file, const ReadFindings& findings) {
  if (findings.has_clear_unit) return;
  throw InputError(fmt::format(
      "{}: stamps are whole numbers, in {} or in {}: expected --stamp-unit, or stamp_unit in a "
      "config",
      file,
      to_text(findings.units[0]),
      to_text(findings.units[1])));
}

}  // namespace loopbench
