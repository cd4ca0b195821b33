/// Cross-validation: a setting chosen on some groups of chains, evaluated on the group left out.
#pragma once

#include <string>
#include <vector>

namespace loopbench {

/// log(ATE / baseline's ATE) of each chain of a group under each setting.
struct GroupRatios {
  std::string group;
  std::string part;  ///< groups of one part are left out together
  std::vector<std::vector<double>> logs;
};

struct LeftOutEstimate {
  double ratio = 1.0;  ///< geometric mean over groups, each with the setting chosen on the others
  double low = 1.0, high = 1.0;  ///< 95 %, bootstrap over groups and chains
  double worst = 1.0;
  std::size_t above = 0;            ///< chains whose ratio is above 1.05
  std::vector<std::size_t> chosen;  ///< setting for each group
};

/// Mean of the chains' log ratios under one setting.
double mean_log(const GroupRatios& group, std::size_t setting);

/// For every part, selects the setting with the lowest mean over all groups of the other parts
/// (with equal weights) and evaluates it on the groups of this part. Bit-identical for equal seeds.
/// O(draws chains + parts groups settings).
LeftOutEstimate left_out(const std::vector<GroupRatios>& groups, int draws = 4000);

}  // namespace loopbench
