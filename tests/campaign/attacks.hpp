/// The attacks of a campaign. To add one, add a line to attacks().
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/campaign/history.hpp"

namespace loopbench::campaign {

struct Attack {
  std::string name;
  unsigned weight = 1;  ///< relative frequency
  /// Attacks the history's sweep, and throws Broken if something reported as done is lost, an exit
  /// code is wrong or a process is left. Every attack leaves a store that `run` can resume.
  std::function<void(History& history)> act;
};

std::vector<Attack> attacks();

}  // namespace loopbench::campaign
