#include "harness/execution/sandbox/system_file.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace loopbench::harness {

std::string read_system_file(const std::string& path) {
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

bool write_system_file(const std::string& path, const std::string& text) {
  const int file = open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool is_written = write(file, text.data(), text.size()) >= 0;
  close(file);
  return is_written;
}

}  // namespace loopbench::harness
