/// What a method consists of. Labels mean nothing: whoever asks for a stage reads it here.
#pragma once

#include "harness/sweep/model/shared_text.hpp"

namespace loopbench::harness {

/// Catalogue names of the stages, each empty if the method has none.
struct MethodParts {
  SharedText replay = {};
  SharedText corrector = {};  ///< or a method that is both
  SharedText smoother = {};
  SharedText program = {};  ///< the command of a stage that is one

  friend bool operator==(const MethodParts&, const MethodParts&) = default;
};

}  // namespace loopbench::harness
