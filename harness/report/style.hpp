/// Colours and dashes of curves, the same in every figure.
#pragma once

#include <array>
#include <cstddef>

namespace loopbench::harness {

inline constexpr const char* kReferenceColor = "#9aa1ab";

struct CurveStyle {
  const char* color;
  int dash;  ///< 1: solid, 2 to 5: dashed
};

/// Solid, then four dash types.
inline constexpr int dash_of(std::size_t index) { return 1 + static_cast<int>(index % 5); }

/// Style of the curve with this index, of a method among all methods of a sweep or of a file among
/// all files of a command. Ten colours, then the same colours dashed.
inline CurveStyle curve_style(std::size_t index) {
  constexpr std::array kColors{"#d93025",
                               "#0b6fd3",
                               "#0f9d58",
                               "#e8710a",
                               "#7b3ff2",
                               "#00a3a3",
                               "#c2185b",
                               "#b58900",
                               "#4a5bd4",
                               "#8d5524"};
  return {kColors[index % kColors.size()], dash_of(index / kColors.size())};
}

}  // namespace loopbench::harness
