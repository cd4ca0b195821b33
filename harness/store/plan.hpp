/// All cells of a sweep by position, as stored next to its results.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/model/cells.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Text of the plan: the labels of all methods, then for each dataset its label, its repeats and
/// its methods. A few lines for a million cells. `all`: every cell, in order.
std::string plan_text(const Sweep& sweep, const std::vector<Cell>& all);

class SweepPlan {
 public:
  /// `text`: of plan_text(); lines in another format are ignored.
  explicit SweepPlan(const std::string& text);

  /// Number of cells, whose positions are 0 to size() - 1.
  std::int64_t size() const { return size_; }

  /// "SEQUENCE / METHOD" or "SEQUENCE (repeat N) / METHOD". O(datasets).
  std::string label(std::int64_t position) const;

 private:
  struct Dataset {
    std::string label;
    std::int64_t repeats = 1;
    std::vector<std::size_t> methods;  ///< indices
  };

  std::vector<std::string> methods_;
  std::vector<Dataset> datasets_;
  std::int64_t size_ = 0;
};

/// The shards that are missing in `lines` "3/8 DIVISION", of divisions that others belong to.
std::vector<std::string> missing_shards(const std::string& lines);

}  // namespace loopbench::harness
