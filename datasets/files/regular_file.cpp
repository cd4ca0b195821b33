#include "datasets/files/regular_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "datasets/core/error.hpp"

namespace loopbench {
namespace {

/// "a text file", "an image"
std::string with_article(const std::string& what) {
  const bool vowel = std::strchr("aeiou", what.empty() ? 'x' : what.front()) != nullptr;
  return (vowel ? "an " : "a ") + what;
}

InputError unreadable(const std::string& name, int reason) {
  return input_error(name, 0, std::string("cannot be read: ") + std::strerror(reason));
}

}  // namespace

RegularFile::RegularFile(const std::filesystem::path& file, const std::string& what)
    : name_(file.string()),
      // Without O_NONBLOCK, opening a pipe waits for a writer.
      descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK)) {
  if (descriptor_ < 0 && errno == ENOENT) throw input_error(name_, 0, "no such " + what);
  if (descriptor_ < 0 && errno == ENXIO) {
    throw input_error(name_, 0, "is not a regular file, expected " + with_article(what));
  }
  if (descriptor_ < 0) throw unreadable(name_, errno);
  struct stat status {};
  const int reason = ::fstat(descriptor_, &status) == 0 ? 0 : errno;
  if (reason == 0 && S_ISREG(status.st_mode)) {
    size_ = static_cast<std::size_t>(status.st_size);
    return;
  }
  ::close(descriptor_);
  if (reason != 0) throw unreadable(name_, reason);
  throw input_error(
      name_,
      0,
      (S_ISDIR(status.st_mode) ? "is a folder, expected " : "is not a regular file, expected ") +
          with_article(what));
}

RegularFile::~RegularFile() { ::close(descriptor_); }

std::size_t RegularFile::read(char* out, std::size_t size) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count = ::read(descriptor_, out + done, size - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw unreadable(name_, errno);
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  return done;
}

std::string read_regular_file(const std::filesystem::path& file,
                              std::size_t most,
                              const std::string& what) {
  RegularFile in(file, what);
  if (in.size() > most) {
    throw input_error(
        file.string(),
        0,
        "has " + std::to_string(in.size()) + " bytes, expected at most " + std::to_string(most));
  }
  std::string out(in.size(), '\0');
  out.resize(in.read(out.data(), out.size()));
  return out;
}

}  // namespace loopbench
