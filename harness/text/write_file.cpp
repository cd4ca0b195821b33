#include "harness/text/write_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "datasets/core/error.hpp"

namespace loopbench::harness {
namespace {

using FilePath = std::filesystem::path;

InputError cannot_write(const FilePath& file, const std::string& why) {
  return input_error(file.string(), 0, "cannot be written: " + why);
}

/// Returns 0 or errno.
int write_all(int descriptor, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = ::write(descriptor, text.data() + done, text.size() - done);
    if (count < 0 && errno != EINTR) return errno;
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  return 0;
}

/// Writes and closes; returns 0 or errno. Some file systems report a full disk only on closing.
int write_and_close(int descriptor, const std::string& text) {
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
void write_into(const FilePath& file, const struct stat& status, const std::string& text) {
  // Standard output is written at its current position: opening it again would write from the
  // start of the file.
  const bool is_own_output = is_standard_output(status);
  if (is_own_output) std::fflush(stdout);
  const int descriptor =
      is_own_output ? ::dup(STDOUT_FILENO) : ::open(file.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  const int reason = descriptor < 0 ? errno : write_and_close(descriptor, text);
  if (reason != 0) throw cannot_write(file, std::strerror(reason));
}

/// Creates a new temporary file in the folder of `file`; returns its descriptor, or -1 and errno.
int create_beside(const FilePath& file, FilePath& part) {
  for (int i = 0;; ++i) {
    part = file;
    part += ".part-" + std::to_string(::getpid()) + "-" + std::to_string(i);
    const int descriptor = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0 || errno != EEXIST) return descriptor;
  }
}

}  // namespace

bool is_dash(const FilePath& file) { return file == "-"; }

void reject_standard_output(const std::string& option, const FilePath& file) {
  if (!is_dash(file)) return;
  throw InputError(option + " -: cannot be written to standard output, expected a name");
}

void write_file(const FilePath& file, const std::string& text) {
  if (is_dash(file)) {
    std::fwrite(text.data(), 1, text.size(), stdout);  // main() reports write errors
    return;
  }
  struct stat status {};
  const bool exists = ::stat(file.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) throw cannot_write(file, "is a folder");
  if (exists && (!S_ISREG(status.st_mode) || is_standard_output(status))) {
    return write_into(file, status, text);
  }
  // Renaming ignores the file's permissions, and root bypasses them.
  const bool is_read_only = exists && (status.st_mode & (S_IWUSR | S_IWGRP | S_IWOTH)) == 0;
  if (is_read_only || (exists && ::access(file.c_str(), W_OK) != 0)) {
    throw cannot_write(file, is_read_only ? "is read-only" : std::strerror(errno));
  }

  const FilePath target = link_target(file);
  std::error_code error;
  if (target.has_parent_path()) std::filesystem::create_directories(target.parent_path(), error);
  FilePath part;
  const int descriptor = create_beside(target, part);
  if (descriptor < 0) throw cannot_write(file, std::strerror(errno));
  if (exists) ::fchmod(descriptor, status.st_mode & 0777);
  const int reason = write_and_close(descriptor, text);
  if (reason == 0) std::filesystem::rename(part, target, error);
  if (reason == 0 && !error) return;
  const std::string why = reason != 0 ? std::strerror(reason) : error.message();
  std::filesystem::remove(part, error);
  throw cannot_write(file, why);
}

void reject_overwriting(const std::vector<FilePath>& inputs, const FilePath& file) {
  std::error_code error;
  if (is_dash(file) || !std::filesystem::is_regular_file(file, error)) return;
  for (const FilePath& input : inputs) {
    if (std::filesystem::equivalent(input, file, error) && !error) {
      throw input_error(file.string(), 0, "is an input of this command and is not overwritten");
    }
  }
}

}  // namespace loopbench::harness
