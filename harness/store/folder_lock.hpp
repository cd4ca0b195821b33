/// Lock that allows one sweep per folder.
#pragma once

#include <filesystem>

namespace loopbench::harness {

/// Locks a folder until destroyed or until the process ends; a killed process leaves no lock
/// behind.
class FolderLock {
 public:
  /// Throws InputError if another process holds the lock, or the folder cannot be opened.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace loopbench::harness
