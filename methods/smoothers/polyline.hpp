/// Linear interpolation of positions and slerp of rotations between the keyframes: the baseline
/// smoother.
#pragma once

#include "datasets/core/polyline.hpp"
#include "methods/method.hpp"

namespace loopbench::methods {

class PolylineSmoother final : public Smoother {
 public:
  struct Options {};
  explicit PolylineSmoother(const Options&) {}

  std::unique_ptr<const Curve> smooth(const Problem& problem, Report&) const override {
    return std::make_unique<Polyline>(problem.keyframes);
  }
};

template <class Visit>
void fields(PolylineSmoother::Options&, Visit) {}

}  // namespace loopbench::methods
