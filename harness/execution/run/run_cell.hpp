/// Running one cell: only the method's verb is timed, and whatever it throws stays in its row.
#pragma once

#include "datasets/core/sequence.hpp"
#include "harness/catalogue/catalogue.hpp"
#include "harness/model/result.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench {

/// The stages of a choice as one method; only an oracle is shown `reference`. Throws InputError,
/// OptionError.
std::unique_ptr<const Method> make_method(const MethodChoice& choice,
                                          const Catalogue& catalogue,
                                          const Trajectory& reference);

/// Never throws for what a method or metric does: that becomes status and why.
CellResult run_cell(const Cell& cell,
                    const Sweep& sweep,
                    const Sequence& sequence,
                    const Catalogue& catalogue);

}  // namespace loopbench
