/// Option values that `loopbench calibrate` learnt, as a config's entry takes them over.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/config/grid.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench {

struct LearntSettings {
  TrainingData trained_on;
  std::map<std::string, std::vector<Setting>> by_method;
};

/// The settings under each of the `methods` that the calibration file has; at least one of them.
/// The file is looked for beside the config, then as given. The settings' line is that of the
/// config, so that a refusal tells where the file was named. Throws InputError `config:line:`.
LearntSettings read_calibration(const std::string& calibration,
                                const std::vector<std::string>& methods,
                                const std::string& config,
                                std::size_t line);

}  // namespace loopbench
