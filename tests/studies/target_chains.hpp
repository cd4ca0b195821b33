/// Chains of the article's sequences, and chains with perfect closures.
#pragma once

#include <vector>

#include "tests/studies/development_chains.hpp"

namespace loopbench {

/// The targets of the article's sequences (configs of results/methods/argument.md and
/// argument_mono.md). Throws DataMissing.
std::vector<DevelopmentChain> target_chains(const DataRoot& root);

/// The chain with its closures measured in the reference without noise, at the same keyframes and
/// with the same covariances. Closures at keyframes without reference are left out.
DevelopmentChain with_exact_closures(const DevelopmentChain& chain);

}  // namespace loopbench
