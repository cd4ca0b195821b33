/// Runs one cell; only the method is timed, and its exceptions are stored in its row.
#pragma once

#include <string_view>

#include "datasets/core/sequence.hpp"
#include "harness/catalogue/catalogue.hpp"
#include "harness/catalogue/command.hpp"
#include "harness/model/result.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Begins the note of a cell whose timed runs gave different trajectories.
inline constexpr std::string_view kNondeterministic = "nondeterministic: ";

/// Combines the stages of a choice into one method; only an oracle has access to `reference`, and
/// only a program uses `setting`. Throws InputError, OptionError.
std::unique_ptr<const methods::Estimator> make_method(const MethodChoice& choice,
                                                      const Catalogue& catalogue,
                                                      const Trajectory& reference,
                                                      const CommandSetting& setting = {});

/// Call it in a new process, for its memory and time. Does not throw for errors of a method or
/// metric: they are stored as status and why.
CellResult run_cell(const Cell& cell,
                    const Sweep& sweep,
                    const Sequence& sequence,
                    const Catalogue& catalogue);

}  // namespace loopbench::harness
