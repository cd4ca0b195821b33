/// One-line provenance for the end of an export.
#pragma once

#include <map>
#include <string>

namespace loopbench::harness {

/// "loopbench 0.3.0 (a9736e1dc55d, dirty), GNU 12.2.0, -O3 -DNDEBUG; AMD EPYC, Linux 6.1 x86_64".
/// From a store's provenance; values that differ between its cells are separated by slashes.
std::string build_summary(const std::map<std::string, std::string>& provenance);

}  // namespace loopbench::harness
