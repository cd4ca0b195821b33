/// Input files that are missing or broken, found before anything runs.
#pragma once

#include <string>
#include <vector>

#include "harness/catalogue.hpp"
#include "harness/run/cells.hpp"
#include "harness/sweep.hpp"

namespace loopbench {

/// Loads every sequence of the cells once (with its first seed), or inspects it where loading takes
/// long. Returns "LABEL: reason" for each that cannot be loaded.
std::vector<std::string> bad_inputs(const Sweep& sweep,
                                    const std::vector<Cell>& cells,
                                    const Catalogue& catalogue,
                                    const DataRoot& root);

/// Throws MissingPart when a sequence of the cells needs a part that this build was made without.
void require_parts(const Sweep& sweep, const std::vector<Cell>& cells, const Catalogue& catalogue);

}  // namespace loopbench
