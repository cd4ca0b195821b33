/// What a user sees while a sequence is made from images, and where its stages are kept.
#pragma once

#include <string>
#include <vector>

#include "datasets/rgbd/frontend.hpp"

namespace loopbench {

/// A bar on stderr when that is a terminal. Stages are kept in $LOOPBENCH_CACHE (empty: nowhere),
/// else in $XDG_CACHE_HOME/loopbench, else in ~/.cache/loopbench.
FrontendHooks loading_hooks();

/// Prints the notes of a sequence on stderr, each after `label`.
void tell(const std::string& label, const std::vector<std::string>& notes);

/// "[####......] 120/415  tracking".
std::string loading_line(const std::string& stage, std::size_t done, std::size_t total);

}  // namespace loopbench
