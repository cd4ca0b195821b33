/// Number of errors behind the values of a table, if it differs from the evaluated poses.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "harness/model/record.hpp"

namespace loopbench::harness {

/// A relative error has fewer pairs than evaluated poses, a closure residual one error per closure.
class ErrorCounts {
 public:
  /// Ignores single values and scores with as many errors as evaluated poses.
  void add(std::size_t column, const Record& record);

  /// "rpe 1 s [m]: 396 to 398; ..."; empty if every value is over the evaluated poses.
  std::string text(const std::vector<std::string>& columns) const;

 private:
  std::map<std::size_t, std::pair<std::size_t, std::size_t>> range_;  ///< min, max by column
};

}  // namespace loopbench::harness
