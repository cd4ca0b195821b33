/// Loading the datasets that a sweep names, with the seeds of its repeats.
#pragma once

#include <vector>

#include "datasets/core/sequence.hpp"
#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/model/cells.hpp"
#include "harness/sweep/model/sweep.hpp"

namespace loopbench::harness {

/// Whether each dataset of the sweep has a `seed` option, so that repeats mean something.
std::vector<bool> seeded(const Sweep& sweep, const Catalogue& catalogue);

/// Loads the sequence of a cell, with the seed of its repeat. Throws InputError with the dataset's
/// label when a file is missing or broken.
Sequence load_sequence(const Cell& cell,
                       const Sweep& sweep,
                       const Catalogue& catalogue,
                       const DataRoot& root);

/// All options including defaults, integers written as reals if the default is real: setting a
/// default explicitly, or 1 instead of 1.0, makes no difference.
Params in_full(const std::vector<OptionInfo>& options, const Params& given);

/// The dataset's options in full, defaults included, with the seed of this repeat.
Params full_options(const DatasetChoice& choice, const DatasetEntry& entry, int repeat);

}  // namespace loopbench::harness
