/// Progress display and cache folder for sequences computed from images.
#pragma once

#include <string>
#include <vector>

#include "datasets/rgbd/frontend.hpp"

extern char front_end_hash[];  ///< of the library of the image front end; defined by the build

namespace loopbench::harness {

/// Progress bar on stderr if that is a terminal. Stages are cached in $LOOPBENCH_CACHE (empty: no
/// cache), otherwise in $XDG_CACHE_HOME/loopbench, otherwise in ~/.cache/loopbench.
rgbd::FrontendHooks loading_hooks();

/// Prints the notes of a sequence to stderr, each prefixed with `label`.
void print_notes(const std::string& label, const std::vector<std::string>& notes);

/// "[####......] 120/415  tracking".
std::string loading_line(const std::string& stage, std::size_t done, std::size_t total);

}  // namespace loopbench::harness
