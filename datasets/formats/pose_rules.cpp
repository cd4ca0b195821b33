#include "datasets/formats/pose_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "datasets/core/params.hpp"

namespace loopbench {

Rotation normalized_rotation(const TextFile& file, std::size_t line, Rotation given) {
  constexpr double kTolerance = 1e-2;
  // Quaternions that are unit up to rounding are not changed, so that round trips are
  // bit-identical.
  constexpr double kRounding = 4e-15;
  const double square = given.squaredNorm();
  if (std::abs(square - 1.0) <= kRounding) return given;
  const double norm = std::sqrt(square);
  if (norm < 1e-12) throw file.error(line, "quaternion is zero, expected norm 1");
  if (!(std::abs(norm - 1.0) <= kTolerance)) {
    throw file.error(line, fmt::format("quaternion has norm {:.6g}, expected 1 +- 0.01", norm));
  }
  file.repaired.off_unit = std::max(file.repaired.off_unit, std::abs(norm - 1.0));
  given.coeffs() /= norm;
  return given;
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
