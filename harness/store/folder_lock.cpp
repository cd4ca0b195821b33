#include "harness/store/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "datasets/core/error.hpp"

namespace loopbench::harness {

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0) {
    throw InputError(folder.string() + ": cannot be opened: " + std::strerror(errno));
  }
  if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  const int reason = errno;
  close(descriptor_);
  if (reason == EWOULDBLOCK) {
    throw InputError(folder.string() +
                     ": another sweep is writing its results here; wait for it, "
                     "or choose another folder with --out");
  }
  throw InputError(folder.string() + ": cannot be locked: " + std::strerror(reason));
}

FolderLock::~FolderLock() { close(descriptor_); }

}  // namespace loopbench::harness
