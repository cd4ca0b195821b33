/// Colours and dashes of curves, the same in every figure.
#pragma once

#include <array>
#include <cstddef>

namespace loopbench::harness {

struct CurveStyle {
  const char* color;
  int dash;  ///< 1: solid, 2 to 5: dashed
};

/// Style of the curve with this index, of a method among all methods of a sweep or of a file among
/// all files of a command. The colours are those of python/loopbench/panels.py; each has a dash,
/// too, and 40 curves differ.
inline CurveStyle curve_style(std::size_t index) {
  constexpr std::array kColors{
      "#cc4c02", "#0068b0", "#2aa59a", "#7d1d6f", "#efb400", "#7fb8ec", "#5c3a14", "#f2a0c0"};
  return {kColors[index % kColors.size()], 1 + static_cast<int>(index % 5)};
}

}  // namespace loopbench::harness
