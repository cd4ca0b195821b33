/// Folders for temporary files of programs, named by TMPDIR.
#pragma once

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace loopbench::harness {

/// A new folder in TMPDIR, removed by the destructor.
class NewFolder {
 public:
  /// Throws std::runtime_error if it cannot be created.
  explicit NewFolder(const std::string& prefix) {
    std::string name = (std::filesystem::temp_directory_path() / (prefix + "XXXXXX")).string();
    if (mkdtemp(name.data()) == nullptr) {
      throw std::runtime_error(name + ": cannot be created: " + std::strerror(errno));
    }
    path_ = name;
  }
  ~NewFolder() { remove(); }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  void remove() const {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

 private:
  std::filesystem::path path_;
};

/// For the files of one run of a program.
struct ExchangeFolder : NewFolder {
  static constexpr const char* kPrefix = "loopbench-exchange-";
  ExchangeFolder() : NewFolder(kPrefix) {}
};

/// Becomes TMPDIR of this process and of those started from it, until the destructor.
class ScratchFolder {
 public:
  ScratchFolder() { setenv("TMPDIR", folder_.path().c_str(), 1); }
  ~ScratchFolder() { setenv("TMPDIR", before_.c_str(), 1); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return folder_.path(); }

  /// Removes the folders of exchanges whose process was killed.
  void remove_exchanges() const {
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(path(), ignored)) {
      if (entry.path().filename().string().starts_with(ExchangeFolder::kPrefix)) {
        std::filesystem::remove_all(entry.path(), ignored);
      }
    }
  }

  /// Removes it now, and the folder that contains it unless others are left in there. For a process
  /// that ends without destructors, possibly after the one that it was forked from.
  void remove_with_parent() const {
    folder_.remove();
    std::error_code ignored;
    std::filesystem::remove(path().parent_path(), ignored);  // fails unless it is empty
  }

 private:
  std::filesystem::path before_ = std::filesystem::temp_directory_path();
  NewFolder folder_{"loopbench-"};
};

}  // namespace loopbench::harness
