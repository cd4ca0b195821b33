/// What the kernel tells about processes and sets for them, in /proc.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace loopbench::harness {

/// The text of a file; "" if it cannot be read.
std::string read_system_file(const std::string& path);

/// Writes an existing file; false if the system refuses.
bool write_system_file(const std::string& path, const std::string& text);

/// The memory after `name` ("RssAnon:") in the text of /proc/PROCESS/status [bytes].
std::optional<std::int64_t> memory_in(const std::string& status, const char* name);

/// Limits the private writable memory of this process, used or not, to `growth` bytes more than
/// now. Does nothing without /proc.
void limit_data_memory(std::int64_t growth);

}  // namespace loopbench::harness
