/// What this program is.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace loopbench {

/// Version, compiler, flags, versions of the libraries it was built with, by name.
std::vector<std::pair<std::string, std::string>> build_facts();

/// A hash of the running program's code and constants, of build_facts(), of the names of its shared
/// libraries (which hold their versions) and of the C library's version: another build that could
/// give other numbers has another. Constant while it runs, some milliseconds the first time.
const std::string& build_id();

}  // namespace loopbench
