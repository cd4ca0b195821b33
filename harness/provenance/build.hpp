/// Identification of this program's build.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace loopbench::harness {

/// Version, compiler, flags, versions of the libraries it was built with, by name.
std::vector<std::pair<std::string, std::string>> build_facts();

/// Hash of the running program's code and constants, of build_facts(), of the names of its shared
/// libraries (which contain their versions) and of the C library's version: it differs for every
/// build that could give other results. Constant during a run; takes some milliseconds on the first
/// call.
const std::string& build_id();

}  // namespace loopbench::harness
