#include "datasets/columns/pose_rules.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/columns/csv_header.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/core/params.hpp"
#include "datasets/core/se3.hpp"

namespace loopbench {

InputError wrong_norm(const TextFile& file, std::size_t line, double norm) {
  if (norm < 1e-12) throw InvalidRow(file.error(line, "quaternion is zero, expected norm 1"));
  return file.error(line, fmt::format("quaternion has norm {:.6g}, expected 1 +- 0.01", norm));
}

Trajectory local_positions(Trajectory geodetic,
                           const ReadOptions& options,
                           ReadFindings& findings) {
  if (geodetic.empty()) return geodetic;
  const GeodeticOrigin origin = options.origin.value_or(origin_of(geodetic));
  findings.origin = origin;
  return to_local(std::move(geodetic), origin);
}

void reject_mixed_rows(const TextFile& file,
                       const Line& line,
                       bool is_zero,
                       const ReadOptions& options,
                       Trajectory& above) {
  if (is_zero) {
    throw InvalidRow(
        file.error(line.number, "quaternion is zero, expected norm 1 as in the rows above"));
  }
  if (!options.drop_invalid) {
    throw file.error(line.number,
                     "has a rotation, expected a zero quaternion (positions without rotation) as "
                     "in the rows above (or --drop-invalid)");
  }
  ReadFindings& found = file.repaired;
  found.invalid += above.size();
  found.dropped.resize(found.rows);  // all rows above
  std::iota(found.dropped.begin(), found.dropped.end(), std::size_t{0});
  found.covariances.clear();
  above.clear();
}

InputError with_remedy(const InvalidRow& error) {
  return InputError(std::string(error.what()) +
                    " (--drop-invalid, or drop_invalid: true in a config)");
}

namespace {

/// Why many different rows repeat the stamp above them, as far as the stamps show; otherwise empty.
/// O(rows).
std::string few_stamps(const TextFile& file, std::size_t column) {
  TextFile reopened = file.reopened();
  std::vector<std::string_view> row;
  std::string stamp, text;
  std::size_t rows = 0, repeated = 0;
  for (Line line; reopened.next(line); text = line.text) {
    split_columns(line.text, row);
    if (row.size() <= column) continue;
    if (row[column] == stamp && line.text != text) ++repeated;
    stamp = row[column];
    ++rows;
  }
  if (repeated < 2 || 5 * repeated < rows) return "";
  return fmt::format(
      "{} of {} rows have the stamp of the row above: {}. Write stamps with all digits (%.9f); if "
      "no pose is missing, `eval --association index` pairs row by row",
      repeated,
      rows,
      stamp_number(stamp) == 0.0 ? "stamps are 0, as if they were not recorded"
                                 : "stamps have too few digits");
}

}  // namespace

bool StampOrder::is_later(double& stamp, std::string_view word) const {
  if (stamp_word(word) == stamp_word(last_word_)) return false;
  const auto exact = exact_nanoseconds(stamp_word(word), exponent_);
  const auto before = exact_nanoseconds(stamp_word(last_word_), exponent_);
  if (!exact || !before || *exact <= *before) return false;
  stamp = std::nextafter(last_stamp_, std::numeric_limits<double>::infinity());
  return true;
}

bool agrees_with_last(const Trajectory& poses, const Pose& again) {
  constexpr std::size_t kRecent = 8;
  constexpr double kMost = 2.0;
  if (poses.empty()) return false;
  const auto distance = [](const Pose& a, const Pose& b) {
    return (a.translation - b.translation).norm();
  };
  const auto angle = [](const Pose& a, const Pose& b) {
    return has_rotation(a) && has_rotation(b) ? a.rotation.angularDistance(b.rotation) : 0.0;
  };
  double longest = 0.0, widest = 0.0;
  for (std::size_t i = poses.size() - 1; i > 0 && poses.size() - i < kRecent; --i) {
    const Pose& before = poses[i - 1].world_from_body;
    longest = std::max(longest, distance(before, poses[i].world_from_body));
    widest = std::max(widest, angle(before, poses[i].world_from_body));
  }
  const Pose& last = poses.back().world_from_body;
  return distance(last, again) <= kMost * longest && angle(last, again) <= kMost * widest;
}

void StampOrder::reject_or_drop(double stamp,
                                std::size_t line,
                                const Trajectory* poses,
                                const Pose* pose) {
  const std::string on_line = " on line " + std::to_string(last_line_);
  if (stamp < last_stamp_) {
    throw file_.error(line,
                      "stamp " + to_text(stamp) + " is smaller than stamp " + to_text(last_stamp_) +
                          on_line +
                          ", expected increasing stamps (--sort, or sort: true in a config)");
  }
  if (options_.repeats == Repeats::refuse) {
    const std::string few = has_enough_stamps_ ? "" : few_stamps(file_, column_);
    if (!few.empty()) throw file_.error(line, few);
    has_enough_stamps_ = true;
    if (poses != nullptr && agrees_with_last(*poses, *pose)) {
      ++file_.repaired.agreeing;
      return;
    }
    throw file_.error(line,
                      "stamp " + to_text(stamp) + " is already" + on_line +
                          (poses == nullptr ? ", expected increasing times"
                                            : " with another pose, expected increasing stamps "
                                              "(--repeats keep_first or keep_last, or repeats: in "
                                              "a config)"));
  }
  ++file_.repaired.repeated;
}

}  // namespace loopbench
