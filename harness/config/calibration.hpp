/// Option values of methods from a file, for an entry of a config.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/config/grid.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

struct CalibratedSettings {
  TrainingData trained_on;
  std::map<std::string, std::vector<Setting>> by_method;
};

/// The settings under each of the `methods` in the calibration file, which has at least one. The
/// file is searched relative to the config, then as given. The settings have the line of the config
/// entry, so that messages refer to it. Throws InputError `config:line:`.
CalibratedSettings read_calibration(const std::string& calibration,
                                    const std::vector<std::string>& methods,
                                    const std::string& config,
                                    std::size_t line);

}  // namespace loopbench::harness
