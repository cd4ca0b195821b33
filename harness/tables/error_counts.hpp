/// How many errors the numbers of a table are made of, where those are not the judged poses.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "harness/model/record.hpp"

namespace loopbench {

/// A relative error has fewer pairs than poses were judged, a closure residual one error a closure.
class ErrorCounts {
 public:
  /// Numbers that are single, or of as many errors as poses were judged, are passed over.
  void add(std::size_t column, const Record& record);

  /// "rpe 1 s [m]: 396 to 398; ..."; empty: every number is of the judged poses.
  std::string text(const std::vector<std::string>& columns) const;

 private:
  std::map<std::size_t, std::pair<std::size_t, std::size_t>> range_;  ///< least, most of a column
};

}  // namespace loopbench
