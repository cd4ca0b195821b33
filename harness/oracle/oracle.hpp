/// Methods that are shown the answer, to see what a leak would gain: never to be compared with.
///
/// A Method sees a Problem, and no Problem holds the reference. What is listed here is made with
/// the reference by the harness alone; every row it leaves says so.
#pragma once

#include <vector>

#include "methods/method.hpp"

namespace loopbench {

struct OracleEntry {
  MethodEntry listed;  ///< name, kind, options; what it makes was shown no reference and declines
  std::function<Stage(const Params&, const Trajectory& reference)> make;  ///< throws OptionError
};

/// Every oracle, in the order tables show them.
std::vector<OracleEntry> oracles();

}  // namespace loopbench
