/// Provenance in a line, for the foot of an export.
#pragma once

#include <map>
#include <string>

namespace loopbench {

/// "loopbench 0.1.0 (a9736e1dc55d, dirty), GNU 12.2.0, -O3 -DNDEBUG; AMD EPYC, Linux 6.1 x86_64".
/// Of a store's provenance; what differs between its cells is told with slashes.
std::string made_by(const std::map<std::string, std::string>& provenance);

}  // namespace loopbench
