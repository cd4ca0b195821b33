/// Folder for temporary files of programs, named by TMPDIR.
#pragma once

#include <filesystem>

namespace loopbench::harness {

/// A new folder in TMPDIR, which becomes TMPDIR of this process and of those started from it. The
/// destructor removes it and restores TMPDIR.
class ScratchFolder {
 public:
  ScratchFolder();  ///< throws std::runtime_error if it cannot be created
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }

  /// Removes the folders of exchanges whose process was killed.
  void remove_exchanges() const;

  /// Removes it now, and the folder that contains it unless others are left in there. For a process
  /// that ends without destructors, possibly after the one that it was forked from.
  void remove_with_parent() const;

 private:
  std::filesystem::path before_;
  std::filesystem::path folder_;
};

/// A new folder in TMPDIR for the files of one run of a program, removed by the destructor.
class ExchangeFolder {
 public:
  ExchangeFolder();  ///< throws std::runtime_error if it cannot be created
  ~ExchangeFolder();
  ExchangeFolder(const ExchangeFolder&) = delete;
  ExchangeFolder& operator=(const ExchangeFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

}  // namespace loopbench::harness
