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

/// Whether a method is the user's own: a stage runs a program, or is a plugin's.
bool is_own(const MethodParts& parts);

}  // namespace loopbench::harness
