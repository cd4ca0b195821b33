/// Folders for temporary files of programs, named by TMPDIR.
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace loopbench::harness {

/// A new folder in TMPDIR, removed by the destructor in the process that created it. It is locked
/// meanwhile, so that others can tell it from one that a killed process has left.
class NewFolder {
 public:
  /// Throws std::runtime_error if it cannot be created.
  explicit NewFolder(const std::string& prefix) {
    while (!create(prefix)) close(descriptor_);
  }
  ~NewFolder() {
    if (getpid() == owner_) remove();
    close(descriptor_);
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  void remove() const {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

 private:
  /// False if another process took it for one that is left, before it was locked.
  bool create(const std::string& prefix) {
    std::string name = (std::filesystem::temp_directory_path() / (prefix + "XXXXXX")).string();
    if (mkdtemp(name.data()) == nullptr) {
      throw std::runtime_error(name + ": cannot be created: " + std::strerror(errno));
    }
    path_ = name;
    descriptor_ = open(name.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    return descriptor_ < 0 || (flock(descriptor_, LOCK_EX) != 0 || access(name.c_str(), F_OK) == 0);
  }

  std::filesystem::path path_;
  pid_t owner_ = getpid();
  int descriptor_ = -1;
};

/// For the files of one run of a program.
struct ExchangeFolder : NewFolder {
  static constexpr const char* kPrefix = "loopbench-exchange-";
  ExchangeFolder() : NewFolder(kPrefix) {}
};

/// For the files of a program that serves this process and those forked from it.
struct ServerFolder : NewFolder {
  static std::string prefix() { return "loopbench-serve-" + std::to_string(getpid()) + "-"; }
  ServerFolder() : NewFolder(prefix()) {}
};

inline constexpr std::string_view kSweepPrefix = "loopbench-sweep-";

/// Becomes TMPDIR of this process and of those started from it, until the destructor.
class ScratchFolder {
 public:
  ScratchFolder() { setenv("TMPDIR", folder_.path().c_str(), 1); }
  ~ScratchFolder() { setenv("TMPDIR", before_.c_str(), 1); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return folder_.path(); }

  /// Removes the folders of exchanges whose process was killed, and of servers of other processes
  /// than this one.
  void remove_exchanges() const {
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(path(), ignored)) {
      const std::string name = entry.path().filename().string();
      const bool is_others =
          name.starts_with("loopbench-serve-") && !name.starts_with(ServerFolder::prefix());
      if (name.starts_with(ExchangeFolder::kPrefix) || is_others) {
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
  NewFolder folder_{std::string(kSweepPrefix)};
};

/// Removes folders of this user in TMPDIR that killed sweeps have left: nobody holds their locks.
inline void remove_left_scratch() {
  constexpr std::size_t kRandom = 6;  // characters, see NewFolder
  std::error_code ignored;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::temp_directory_path(), ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kSweepPrefix) || name.size() != kSweepPrefix.size() + kRandom) continue;
    const int descriptor =
        open(entry.path().c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor < 0) continue;
    struct stat status {};
    const bool is_left = fstat(descriptor, &status) == 0 && status.st_uid == geteuid() &&
                         flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    if (is_left) std::filesystem::remove_all(entry.path(), ignored);
    close(descriptor);
  }
}

}  // namespace loopbench::harness
