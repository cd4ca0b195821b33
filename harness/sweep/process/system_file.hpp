/// What the kernel tells about processes and sets for them, in /proc.
#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>

namespace loopbench::harness {

/// The text of a file; "" if it cannot be read.
inline std::string read_system_file(const std::string& path) {
  std::string out;
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return out;
  char buffer[4096];
  for (ssize_t size; (size = read(file, buffer, sizeof buffer)) > 0;) {
    out.append(buffer, static_cast<std::size_t>(size));
  }
  close(file);
  return out;
}

/// Writes an existing file; false if the system refuses.
inline bool write_system_file(const std::string& path, const std::string& text) {
  const int file = open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool is_written = write(file, text.data(), text.size()) >= 0;
  close(file);
  return is_written;
}

/// The memory after `name` ("RssAnon:") in the text of /proc/PROCESS/status [bytes].
inline std::optional<std::int64_t> memory_in(const std::string& status, const char* name) {
  const char* found = std::strstr(status.c_str(), name);
  if (found == nullptr) return std::nullopt;
  return 1024 * std::int64_t{std::strtoll(found + std::strlen(name), nullptr, 10)};
}

/// Limits the private writable memory of this process, used or not, to `growth` bytes more than
/// now. Does nothing without /proc.
inline void limit_data_memory(std::int64_t growth) {
  long long data = 0;                                              // [pages]
  const std::string sizes = read_system_file("/proc/self/statm");  // much faster than status
  if (std::sscanf(sizes.c_str(), "%*d %*d %*d %*d %*d %lld", &data) != 1) return;
  const auto most = static_cast<rlim_t>(data * sysconf(_SC_PAGESIZE) + growth);
  const rlimit both{most, most};
  setrlimit(RLIMIT_DATA, &both);
}

}  // namespace loopbench::harness
