/// Detection of missing or invalid input files before a sweep runs.
#pragma once

#include <string>
#include <vector>

#include "harness/catalogue/catalogue.hpp"
#include "harness/model/cells.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Loads every sequence of the cells once (with its first seed), or inspects it if loading is slow.
/// Returns "LABEL: reason" for each sequence that cannot be loaded. Throws MissingPart if this
/// build cannot read a file.
std::vector<std::string> bad_inputs(const Sweep& sweep,
                                    const std::vector<Cell>& cells,
                                    const Catalogue& catalogue,
                                    const DataRoot& root);

/// Throws MissingPart when a sequence of the cells needs a part that this build was made without.
void require_parts(const Sweep& sweep, const std::vector<Cell>& cells, const Catalogue& catalogue);

}  // namespace loopbench::harness
