/// The labels of all cells of a sweep, as stored next to its results.
#pragma once

#include <string>
#include <vector>

#include "harness/model/cells.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Text of the plan: the labels of all methods, then for each dataset its repeats, the numbers of
/// its methods and its label. `all`: every cell, in order.
std::string plan_text(const Sweep& sweep, const std::vector<Cell>& all);

/// "SEQUENCE / METHOD" or "SEQUENCE (repeat N) / METHOD" of every cell, by position. `text`: of
/// plan_text(); lines in another format are ignored.
std::vector<std::string> planned_labels(const std::string& text);

/// The shards that are missing in `lines` "3/8 DIVISION", of divisions that others belong to.
std::vector<std::string> missing_shards(const std::string& lines);

}  // namespace loopbench::harness
