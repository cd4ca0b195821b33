/// Small losses that all point the same way.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "harness/gate/check.hpp"

namespace loopbench {

/// Collects what each method was and is on every run, and tests whether it got worse.
class ConsistentLosses {
 public:
  void add(const std::string& method,
           const std::string& score,
           const Tolerance& limit,
           Better way,
           double before,
           double now);

  /// Regressions by a one-sided Wilcoxon test on the logarithms of now / before (differences where
  /// one is not positive), Holm-corrected over all methods and scores with an alpha. Scores without
  /// better and worse are not tested.
  std::vector<Finding> findings() const;

 private:
  struct Series {
    std::vector<double> before;
    std::vector<double> now;
    Better way = Better::lower;
    Tolerance limit;
  };
  std::map<std::pair<std::string, std::string>, Series> series_;
};

}  // namespace loopbench
