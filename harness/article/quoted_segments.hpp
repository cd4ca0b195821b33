/// Segments that the article quotes beside its figures, with the curve it calls best there.
#pragma once

namespace loopbench::harness {

struct ClosedRange {
  double low, high;

  constexpr bool holds(double value) const { return low <= value && value <= high; }
};

struct QuotedSegment {
  const char* where;
  const char* sequence;
  const char* candidate;  ///< N and family; sine and rational are printed without N
  ClosedRange speed;      ///< [m/s]
  ClosedRange kappa;      ///< printed without unit; read as [rad] per keyframe
};

constexpr QuotedSegment kQuotedSegments[] = {
    {"Figure 5 a c e", "fr1_room", "N3 parabola", {0.3845, 0.7014}, {0.002, 0.04}},
    {"Figure 5 b d f", "fr1_room", "N4 cubic", {0.2214, 0.4508}, {0.005, 0.018}},
    {"Figure 6 a c e", "fr1_room", "N4 parabola", {0.1331, 0.4580}, {0.0071, 0.0265}},
    {"Text, special segment", "fr1_room", "N5 sine", {0.1006, 0.1770}, {0.0548, 0.0586}},
    {"Figure 7 a c e", "fr3_office", "N4 parabola", {0.2017, 0.3832}, {0.0357, 0.0512}},
    {"Figure 7 b d f", "fr3_office", "N5 cubic", {0.2670, 0.2774}, {0.0011, 0.0032}},
    {"Figure 8 left", "fr3_office", "N4 parabola", {0.1998, 0.3035}, {0.0071, 0.0265}},
    {"Text, special segment", "fr3_office", "N5 rational", {0.1006, 0.1770}, {0.1271, 0.2248}},
};

}  // namespace loopbench::harness
