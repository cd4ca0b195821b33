/// Small files of the kernel, in /proc and /sys.
#pragma once

#include <string>

namespace loopbench::harness {

/// The text of a file; "" if it cannot be read.
std::string read_system_file(const std::string& path);

/// Writes an existing file; false if the system refuses.
bool write_system_file(const std::string& path, const std::string& text);

}  // namespace loopbench::harness
