#include "datasets/files/replace_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "datasets/core/error.hpp"

namespace loopbench {
namespace {

/// `.loopbench-<16 hexadecimal digits>`, which nobody can predict.
std::string random_name() {
  std::uint64_t bits = 0;
  if (::getrandom(&bits, sizeof bits, 0) != sizeof bits) bits = static_cast<unsigned>(::getpid());
  return fmt::format(".loopbench-{:016x}", bits);
}

using FilePath = std::filesystem::path;

bool is_temporary_name(const std::string& name) {
  constexpr std::string_view kPrefix = ".loopbench-";
  return name.starts_with(kPrefix) && name.size() == kPrefix.size() + 16 &&
         name.find_first_not_of("0123456789abcdef", kPrefix.size()) == std::string::npos;
}

/// Removes temporary files that nobody holds a lock on; once per folder and process. O(entries).
void remove_left_files(const FilePath& folder) {
  static std::mutex mutex;
  static std::set<FilePath> done;
  {
    const std::lock_guard lock(mutex);
    if (!done.insert(folder).second) return;
  }
  std::error_code ignored;
  const FilePath place = folder.empty() ? FilePath(".") : folder;
  for (const auto& entry : std::filesystem::directory_iterator(place, ignored)) {
    if (!is_temporary_name(entry.path().filename().string())) continue;
    const int left = ::open(entry.path().c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
    if (left < 0) continue;
    if (::flock(left, LOCK_EX | LOCK_NB) == 0) std::filesystem::remove(entry.path(), ignored);
    ::close(left);
  }
}

/// Creates a new, empty, locked file in `folder`. Returns its descriptor; -1 and errno if the
/// folder cannot be written.
int create_temporary_file(const FilePath& folder, FilePath& file) {
  constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
  for (int i = 0; i < 100; ++i) {
    file = folder / random_name();
    const int descriptor = ::open(file.c_str(), kFlags, 0666);
    if (descriptor < 0 && errno != EEXIST) return -1;
    if (descriptor < 0) continue;
    struct stat status {};
    const bool is_locked = ::flock(descriptor, LOCK_EX) == 0;  // not on every file system
    // Before it was locked, another process can have taken it for one that is left.
    if (!is_locked || (::fstat(descriptor, &status) == 0 && status.st_nlink > 0)) return descriptor;
    ::close(descriptor);
  }
  return -1;
}

/// Closes it.
struct Descriptor {
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

 private:
  int number_;
};

thread_local int syncs_are_off = 0;

InputError cannot_write(const FilePath& file, const std::string& why) {
  return input_error(file.string(), 0, "cannot be written: " + why);
}

/// Returns 0 or errno.
int write_all(int descriptor, std::string_view text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = ::write(descriptor, text.data() + done, text.size() - done);
    if (count < 0 && errno != EINTR) return errno;
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  return 0;
}

/// Resolves symbolic links, also if the target does not exist.
FilePath link_target(FilePath file) {
  constexpr int kMostLinks = 40;  // as in Linux
  std::error_code error;
  for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(file, error); ++i) {
    const FilePath next = std::filesystem::read_symlink(file, error);
    file = file.parent_path() / next;
  }
  return file;
}

bool is_standard_output(const struct stat& status) {
  struct stat out {};
  return ::fstat(STDOUT_FILENO, &out) == 0 && out.st_dev == status.st_dev &&
         out.st_ino == status.st_ino;
}

/// Opens a pipe or device. Standard output is written at its current position: opening it again
/// would write from the start of the file.
int open_existing(const FilePath& file, const struct stat& status) {
  if (!is_standard_output(status)) return ::open(file.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  std::fflush(stdout);
  return ::dup(STDOUT_FILENO);
}

/// Renaming ignores the file's permissions, and root bypasses them.
void reject_read_only(const FilePath& file, const struct stat& status) {
  const bool is_read_only = (status.st_mode & (S_IWUSR | S_IWGRP | S_IWOTH)) == 0;
  if (!is_read_only && ::access(file.c_str(), W_OK) == 0) return;
  throw cannot_write(file, is_read_only ? "is read-only" : std::strerror(errno));
}

}  // namespace

PendingFile::PendingFile(const FilePath& file, Target target) : file_(file) {
  struct stat status {};
  const bool is_named = target == Target::named;
  const int missing = is_named ? ::stat(file.c_str(), &status) : ::lstat(file.c_str(), &status);
  const bool exists = missing == 0;
  if (exists && S_ISDIR(status.st_mode)) throw cannot_write(file, "is a folder");
  const bool is_regular = exists && S_ISREG(status.st_mode);
  if (exists && is_named && (!is_regular || is_standard_output(status))) {
    descriptor_ = open_existing(file, status);
  } else {
    if (is_regular) reject_read_only(file, status);
    place_ = is_named ? link_target(file) : file;
    if (syncs_are_off == 0) remove_left_files(place_.parent_path());
    descriptor_ = create_temporary_file(place_.parent_path(), part_);
    if (descriptor_ < 0) part_.clear();
  }
  if (descriptor_ < 0) throw cannot_write(file, std::strerror(errno));
  if (is_regular && !part_.empty()) ::fchmod(descriptor_, status.st_mode & 0777);
}

PendingFile::~PendingFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  std::error_code ignored;
  if (!part_.empty()) std::filesystem::remove(part_, ignored);
}

void PendingFile::write(std::string_view bytes) {
  const int reason = write_all(descriptor_, bytes);
  if (reason != 0) throw cannot_write(file_, std::strerror(reason));
}

void PendingFile::commit() {
  const bool is_synced = part_.empty() || syncs_are_off > 0 || ::fsync(descriptor_) == 0;
  const int reason = is_synced ? 0 : errno;
  // The lock is kept until the file has its name: another process would take it for one that is
  // left.
  const Descriptor lock{part_.empty() ? -1 : ::fcntl(descriptor_, F_DUPFD_CLOEXEC, 0)};
  const int descriptor = std::exchange(descriptor_, -1);
  // Some file systems report a full disk only on closing.
  if (::close(descriptor) != 0) throw cannot_write(file_, std::strerror(errno));
  if (reason != 0 && reason != EINVAL) throw cannot_write(file_, std::strerror(reason));
  if (part_.empty()) return;
  std::error_code error;
  std::filesystem::rename(part_, place_, error);
  if (error) throw cannot_write(file_, error.message());
  part_.clear();
}

WithoutSync::WithoutSync() { ++syncs_are_off; }
WithoutSync::~WithoutSync() { --syncs_are_off; }

void replace_file(const FilePath& file, std::string_view bytes, Target target) {
  PendingFile out(file, target);
  out.write(bytes);
  out.commit();
}

}  // namespace loopbench
