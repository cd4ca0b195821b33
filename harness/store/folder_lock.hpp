/// One sweep a folder at a time.
#pragma once

#include <filesystem>

namespace loopbench {

/// Holds a folder until destroyed, or until the process ends however it ends: nothing is left
/// behind by a kill.
class FolderLock {
 public:
  /// Throws InputError when another process holds it, or it cannot be opened.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace loopbench
