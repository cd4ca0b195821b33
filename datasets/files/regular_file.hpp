/// Reading of files that other processes may change meanwhile.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace loopbench {

/// A regular file open for reading. It is read and never mapped into memory, so a file that is
/// truncated meanwhile gives fewer bytes and no SIGBUS.
class RegularFile {
 public:
  /// Follows symbolic links. Does not wait for pipes or devices, but throws InputError for them,
  /// for folders and for missing or unreadable files. `what` is the expected content in messages,
  /// for example "image".
  RegularFile(const std::filesystem::path& file, const std::string& what);
  ~RegularFile();
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;

  std::size_t size() const { return size_; }  ///< when it was opened [bytes]

  /// Reads up to `size` bytes; fewer only at the end of the file. Throws InputError.
  std::size_t read(char* out, std::size_t size);

 private:
  std::string name_;
  int descriptor_ = -1;
  std::size_t size_ = 0;
};

/// Returns all bytes of a regular file. Throws InputError as RegularFile does, and for more than
/// `most` bytes.
std::string read_regular_file(const std::filesystem::path& file,
                              std::size_t most,
                              const std::string& what);

}  // namespace loopbench
