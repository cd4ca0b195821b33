#include "datasets/formats/temporary_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <string>
#include <string_view>

namespace loopbench {
namespace {

constexpr std::string_view kBeginning = ".loopbench-";
constexpr std::string_view kHexadecimal = "0123456789abcdef";
constexpr std::size_t kDigits = 16;

std::string random_name() {
  std::uint64_t bits = 0;
  if (::getrandom(&bits, sizeof bits, 0) != sizeof bits) bits = static_cast<unsigned>(::getpid());
  std::string out(kBeginning);
  for (std::size_t i = 0; i < kDigits; ++i, bits >>= 4) out += kHexadecimal[bits & 15];
  return out;
}

bool is_temporary_name(std::string_view name) {
  return name.size() == kBeginning.size() + kDigits && name.starts_with(kBeginning) &&
         name.find_first_not_of(kHexadecimal, kBeginning.size()) == std::string_view::npos;
}

/// Whether the open file still has a name: another process may have removed it before the lock.
bool has_name(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && status.st_nlink > 0;
}

void remove_if_abandoned(const std::filesystem::path& file) {
  const int descriptor =
      ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0) return;
  struct stat status {};
  const bool is_own =
      ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == ::geteuid();
  if (is_own && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) ::unlink(file.c_str());
  ::close(descriptor);
}

}  // namespace

int create_temporary_file(const std::filesystem::path& folder, std::filesystem::path& file) {
  constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
  for (int i = 0; i < 100; ++i) {
    file = folder / random_name();
    const int descriptor = ::open(file.c_str(), kFlags, 0666);
    if (descriptor < 0 && errno != EEXIST) return -1;
    if (descriptor < 0) continue;
    const bool is_locked = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    if (is_locked ? has_name(descriptor) : errno != EWOULDBLOCK) return descriptor;
    ::close(descriptor);  // another process is removing it
  }
  return -1;
}

void remove_abandoned_files(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::directory_iterator it(folder.empty() ? "." : folder, error);
  for (const std::filesystem::directory_iterator end; !error && it != end; it.increment(error)) {
    if (is_temporary_name(it->path().filename().native())) remove_if_abandoned(it->path());
  }
}

}  // namespace loopbench
