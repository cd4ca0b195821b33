/// Messages of `loopbench run` before its cells run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/model/cells.hpp"
#include "harness/store/store.hpp"

namespace loopbench::harness {

/// Prints the list of cells.
void print_plan(const Sweep& sweep, const std::vector<Cell>& planned);

/// Prints the reasons why sequences cannot be loaded to standard error; returns the exit code.
int report_bad_inputs(const std::vector<std::string>& reasons);

/// Prints to standard error which damaged cells are recomputed, if any.
void report_damage(const Resumed& resumed, const std::filesystem::path& store);

}  // namespace loopbench::harness
