/// Identification of this program's build.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace loopbench::harness {

/// Version, compiler, flags, versions of the libraries it was built with, by name.
std::vector<std::pair<std::string, std::string>> build_metadata();

/// Hash of `code` (Source::code), of build_metadata(), of the names of the program's shared
/// libraries (which contain their versions) and of the C library's version: it differs for every
/// build that could give other results, and not for changes of commands, tables or reports.
std::string build_id(const std::string& code);

}  // namespace loopbench::harness
