/// Atomic writing of files: the only writer of complete files.
#pragma once

#include <filesystem>
#include <string_view>

namespace loopbench {

/// Treatment of a name that is a symbolic link, a pipe or a device.
enum class Target {
  /// For files that the user names: links are followed; bytes are written into pipes, devices and
  /// this process's standard output instead of replacing them.
  named,
  /// For names that the program chooses, in folders that others may be able to write to: whatever
  /// has the name, except a folder, is replaced and never opened.
  own,
};

/// replace_file() in pieces.
class PendingFile {
 public:
  /// Throws InputError as replace_file() does.
  PendingFile(const std::filesystem::path& file, Target target);
  /// Without commit(), removes the temporary file.
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  void write(std::string_view bytes);  ///< throws InputError
  void commit();                       ///< call once, at the end; throws InputError

 private:
  std::filesystem::path file_;   ///< as given
  std::filesystem::path place_;  ///< to replace
  std::filesystem::path part_;   ///< temporary file; empty: bytes go directly into a pipe or device
  int descriptor_ = -1;
};

/// Until it is destroyed, files that this thread writes are not synced, and none are removed: for
/// files that do not outlive the sweep, such as those that programs exchange.
class WithoutSync {
 public:
  WithoutSync();
  ~WithoutSync();
  WithoutSync(const WithoutSync&) = delete;
  WithoutSync& operator=(const WithoutSync&) = delete;
};

/// Writes a temporary file in the same folder, waits until it is on the disk, and renames it, so
/// that readers never see a partial file, also after a power cut. The temporary file `.loopbench-*`
/// has an unpredictable name and is created exclusively; it is locked, so that those of killed
/// processes can be told from it: they are removed when a process writes into their folder for the
/// first time. The mode of a replaced regular file is kept. Throws InputError if the folder is
/// missing, if the folder or file cannot be written, if `file` is read-only, or if it is a folder.
void replace_file(const std::filesystem::path& file, std::string_view bytes, Target target);

}  // namespace loopbench
