#include "methods/correctors/raw.hpp"
#include "methods/correctors/uniform.hpp"
#include "methods/method.hpp"
#include "methods/smoothers/cubic_spline.hpp"
#include "methods/smoothers/polyline.hpp"

namespace loopbench {

std::vector<MethodEntry> methods() {
  return {
      // Correctors: keyframes in, keyframes out.
      method<Raw>("raw", "keyframes as the tracker left them"),
      method<Uniform>("uniform", "closing error spread evenly along each loop"),
      method<Uniform>("uniform_position",
                      "closing error spread evenly, positions only",
                      {.rotation = Uniform::Turn::none}),

      // Smoothers: keyframes in, a curve out.
      method<PolylineSmoother>("polyline", "straight lines and great arcs between keyframes"),
      method<CubicSpline>("cubic_spline", "natural cubic spline in time through the keyframes"),
  };
}

}  // namespace loopbench
