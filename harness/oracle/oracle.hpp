/// Oracle methods with access to the reference, which quantify the gain from such a leak; never
/// compared with other methods.
///
/// A method has a Problem as input, and no Problem contains the reference. Only the harness
/// constructs the methods listed here with the reference; every row of theirs is marked.
#pragma once

#include <vector>

#include "methods/method.hpp"

namespace loopbench::harness {

struct OracleEntry {
  methods::MethodEntry
      listed;  ///< name, kind, options; it makes a method without reference that declines
  std::function<methods::Stage(const Params&, const Trajectory& reference)>
      make;  ///< throws OptionError
};

/// All oracles, in table order.
std::vector<OracleEntry> oracles();

}  // namespace loopbench::harness
