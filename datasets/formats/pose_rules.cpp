#include "datasets/formats/pose_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "datasets/core/params.hpp"

namespace loopbench {

Rotation unit_rotation(const TextFile& file, std::size_t line, Rotation given) {
  constexpr double kTolerance = 1e-2;
  // A quaternion written by us is unit to rounding; leaving it alone makes round trips exact.
  constexpr double kRounding = 4e-15;
  const double square = given.squaredNorm();
  if (std::abs(square - 1.0) <= kRounding) return given;
  const double norm = std::sqrt(square);
  if (norm < 1e-12) throw file.error(line, "quaternion is zero, expected unit length");
  if (!(std::abs(norm - 1.0) <= kTolerance)) {
    throw file.error(line, fmt::format("quaternion has length {:.6g}, expected 1 +- 0.01", norm));
  }
  file.mended.off_unit = std::max(file.mended.off_unit, std::abs(norm - 1.0));
  given.coeffs() /= norm;
  return given;
}

void InOrder::refuse_or_drop(double stamp, std::size_t line) const {
  const std::string before = " on line " + std::to_string(last_line_);
  if (stamp < last_stamp_) {
    throw file_.error(line,
                      "stamp " + to_text(stamp) + " is before stamp " + to_text(last_stamp_) +
                          before + ", expected increasing stamps");
  }
  if (repeats_ == Repeats::refuse) {
    throw file_.error(line,
                      "stamp " + to_text(stamp) + " is already" + before +
                          ", expected increasing stamps" + hint_);
  }
  ++file_.mended.repeated;
}

}  // namespace loopbench
