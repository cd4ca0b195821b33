/// No correction: the baseline for all gains.
#pragma once

#include "methods/method.hpp"

namespace loopbench::methods {

class Raw final : public Corrector {
 public:
  struct Options {};
  explicit Raw(const Options&) {}

  Trajectory correct(const Problem& problem, Report&) const override { return problem.keyframes; }
};

template <class Visit>
void fields(Raw::Options&, Visit) {}

}  // namespace loopbench::methods
