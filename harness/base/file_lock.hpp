/// Lock that lets processes take turns.
#pragma once

#include <filesystem>

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

}  // namespace loopbench::harness
