/// What a setting chosen on some groups of chains is worth on the group left out.
#pragma once

#include <string>
#include <vector>

namespace loopbench {

/// log(ATE / baseline's ATE): of each chain of a group, one a setting.
struct GroupRatios {
  std::string group;
  std::string part;  ///< groups of one part are left out together
  std::vector<std::vector<double>> logs;
};

struct LeftOutEstimate {
  double ratio = 1.0;            ///< geometric mean over groups, each judged by others' choice
  double low = 1.0, high = 1.0;  ///< 95 %, bootstrap over groups and chains
  double worst = 1.0;
  std::size_t above = 0;            ///< chains whose ratio is above 1.05
  std::vector<std::size_t> chosen;  ///< setting, one a group
};

/// Mean of the chains' logarithms under one setting.
double mean_log(const GroupRatios& group, std::size_t setting);

/// For every part: the setting of least mean over all groups of other parts (groups count alike),
/// judged on the part's own. Same seed, same bits. O(draws chains + parts groups settings).
LeftOutEstimate left_out(const std::vector<GroupRatios>& groups, int draws = 4000);

}  // namespace loopbench
