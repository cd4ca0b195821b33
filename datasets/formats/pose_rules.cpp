#include "datasets/formats/pose_rules.hpp"

#include <fmt/format.h>

#include <string>

#include "datasets/core/params.hpp"

namespace loopbench {

InputError wrong_norm(const TextFile& file, std::size_t line, double norm) {
  if (norm < 1e-12) return file.error(line, "quaternion is zero, expected norm 1");
  return file.error(line, fmt::format("quaternion has norm {:.6g}, expected 1 +- 0.01", norm));
}

Trajectory local_positions(Trajectory geodetic, const ReadOptions& options) {
  if (geodetic.empty()) return geodetic;
  const GeodeticOrigin origin = options.origin.value_or(origin_of(geodetic));
  if (options.findings) options.findings->origin = origin;
  return to_local(std::move(geodetic), origin);
}

InputError mixed_rows(const TextFile& file, const Line& line, bool is_zero) {
  return file.error(line.number,
                    is_zero ? "quaternion is zero, expected norm 1 as in the rows above"
                            : "has a rotation, expected a zero quaternion (positions without "
                              "rotation) as in the rows above");
}

void StampOrder::reject_or_drop(double stamp, std::size_t line) const {
  const std::string on_line = " on line " + std::to_string(last_line_);
  if (stamp < last_stamp_) {
    throw file_.error(line,
                      "stamp " + to_text(stamp) + " is smaller than stamp " + to_text(last_stamp_) +
                          on_line + ", expected increasing stamps");
  }
  if (repeats_ == Repeats::refuse) {
    throw file_.error(line,
                      "stamp " + to_text(stamp) + " is already" + on_line +
                          ", expected increasing stamps" + hint_);
  }
  ++file_.repaired.repeated;
}

}  // namespace loopbench
