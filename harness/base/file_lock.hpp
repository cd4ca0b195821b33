/// Lock that lets processes take turns.
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "datasets/core/error.hpp"

namespace loopbench::harness {

/// Locks a file, which is created if it is absent and stays, until destroyed or until the process
/// ends. Waits for other holders.
class FileLock {
 public:
  /// Throws InputError if the file cannot be opened for writing.
  explicit FileLock(const std::filesystem::path& file);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int descriptor_;
};

inline FileLock::FileLock(const std::filesystem::path& file)
    : descriptor_(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666)) {
  if (descriptor_ < 0) {
    throw InputError(file.string() + ": cannot be written: " + std::strerror(errno));
  }
  while (flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) {
  }
}

inline FileLock::~FileLock() { close(descriptor_); }

}  // namespace loopbench::harness
