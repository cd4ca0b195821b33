#pragma once

namespace loopbench::metrics {

/// What a gap between stamps may exceed its limit by: printed stamps are rounded to microseconds,
/// and differences of large ones to 2e-7 s [s].
constexpr double kStampRounding = 1e-6;

}  // namespace loopbench::metrics
