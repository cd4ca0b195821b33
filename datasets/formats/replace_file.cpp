#include "datasets/formats/replace_file.hpp"

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>

#include "datasets/core/error.hpp"

namespace loopbench {
namespace {

using FilePath = std::filesystem::path;

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

/// Writes and closes; returns 0 or errno. Some file systems report a full disk only on closing.
int write_and_close(int descriptor, std::string_view text) {
  const int reason = write_all(descriptor, text);
  return ::close(descriptor) != 0 && reason == 0 ? errno : reason;
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

/// Writes into pipes and devices instead of replacing them.
void write_into(const FilePath& file, const struct stat& status, std::string_view text) {
  // Standard output is written at its current position: opening it again would write from the
  // start of the file.
  const bool is_own_output = is_standard_output(status);
  if (is_own_output) std::fflush(stdout);
  const int descriptor =
      is_own_output ? ::dup(STDOUT_FILENO) : ::open(file.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  const int reason = descriptor < 0 ? errno : write_and_close(descriptor, text);
  if (reason != 0) throw cannot_write(file, std::strerror(reason));
}

std::string random_digits() {
  std::uint64_t bits = 0;
  if (::getrandom(&bits, sizeof bits, 0) != sizeof bits) bits = static_cast<unsigned>(::getpid());
  std::string out(16, '0');
  for (char& digit : out) {
    digit = "0123456789abcdef"[bits & 15];
    bits >>= 4;
  }
  return out;
}

/// Creates a new temporary file in `folder`; returns its descriptor, or -1 and errno.
int create_in(const FilePath& folder, FilePath& part) {
  constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
  for (int i = 0; i < 100; ++i) {
    part = folder / (".loopbench-" + random_digits());
    const int descriptor = ::open(part.c_str(), kFlags, 0666);
    if (descriptor >= 0 || errno != EEXIST) return descriptor;
  }
  return -1;
}

/// Renaming ignores the file's permissions, and root bypasses them.
void reject_read_only(const FilePath& file, const struct stat& status) {
  const bool is_read_only = (status.st_mode & (S_IWUSR | S_IWGRP | S_IWOTH)) == 0;
  if (!is_read_only && ::access(file.c_str(), W_OK) == 0) return;
  throw cannot_write(file, is_read_only ? "is read-only" : std::strerror(errno));
}

}  // namespace

void replace_file(const FilePath& file, std::string_view bytes, Target target) {
  struct stat status {};
  const bool is_named = target == Target::named;
  const int missing = is_named ? ::stat(file.c_str(), &status) : ::lstat(file.c_str(), &status);
  const bool exists = missing == 0;
  if (exists && S_ISDIR(status.st_mode)) throw cannot_write(file, "is a folder");
  const bool is_regular = exists && S_ISREG(status.st_mode);
  if (exists && is_named && (!is_regular || is_standard_output(status))) {
    return write_into(file, status, bytes);
  }
  if (is_regular) reject_read_only(file, status);

  const FilePath place = is_named ? link_target(file) : file;
  FilePath part;
  const int descriptor = create_in(place.parent_path(), part);
  if (descriptor < 0) throw cannot_write(file, std::strerror(errno));
  if (is_regular) ::fchmod(descriptor, status.st_mode & 0777);
  const int reason = write_and_close(descriptor, bytes);
  std::error_code error;
  if (reason == 0) std::filesystem::rename(part, place, error);
  if (reason == 0 && !error) return;
  const std::string why = reason != 0 ? std::strerror(reason) : error.message();
  std::filesystem::remove(part, error);
  throw cannot_write(file, why);
}

}  // namespace loopbench
