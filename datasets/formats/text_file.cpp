#include "datasets/formats/text_file.hpp"

#include <sys/types.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

namespace loopbench {
namespace {

constexpr std::size_t kMaxSize = std::size_t{8} << 30;   // [bytes]; 1e6 poses need 0.1 GB
constexpr std::size_t kWindow = std::size_t{256} << 10;  // [bytes], fits into the L2 cache
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::size_t size_of_plain_file(const std::filesystem::path& file, const std::string& name) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw input_error(name, 0, "no such file");
  }
  if (error) throw input_error(name, 0, "cannot be read: " + error.message());
  if (std::filesystem::is_directory(status)) {
    throw input_error(name, 0, "is a directory, expected a text file");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw input_error(name, 0, "is not a regular file, expected a text file");
  }
  const auto size = std::filesystem::file_size(file, error);
  if (error) throw input_error(name, 0, "cannot be read: " + error.message());
  if (size == 0) throw input_error(name, 0, "is empty");
  if (size > kMaxSize) {
    throw input_error(
        name,
        0,
        "has " + std::to_string(size) + " bytes, expected at most " + std::to_string(kMaxSize));
  }
  return static_cast<std::size_t>(size);
}

}  // namespace

TextFile::TextFile(const std::filesystem::path& file)
    : TextFile(file.string(), size_of_plain_file(file, file.string()), 0, kMaxSize) {}

TextFile::TextFile(const std::string& name, std::size_t size, std::size_t begin, std::size_t end)
    : name_(name),
      size_(size),
      begin_(begin),
      unread_(begin),
      end_(std::min(size, end)),
      capacity_(std::min(kWindow, end_ - begin)),
      handle_(std::fopen(name.c_str(), "rb")) {
  if (!handle_) throw error(0, std::string("cannot be read: ") + std::strerror(errno));
  std::setvbuf(handle_.get(), nullptr, _IONBF, 0);
  if (fseeko(handle_.get(), static_cast<off_t>(begin), SEEK_SET) != 0) {
    throw error(0, std::string("cannot be read: ") + std::strerror(errno));
  }
  window_ = std::make_unique_for_overwrite<char[]>(capacity_);
  refill();
  if (begin == 0 && std::string_view(window_.get(), filled_).starts_with(kByteOrderMark)) {
    position_ = kByteOrderMark.size();
  }
}

/// Reads the next bytes into the window. Drops the lines already read, or doubles the window if a
/// single line fills it.
void TextFile::refill() {
  filled_ -= position_;
  if (filled_ == capacity_) {
    auto larger = std::make_unique_for_overwrite<char[]>(2 * capacity_);
    std::memcpy(larger.get(), window_.get(), filled_);
    window_ = std::move(larger);
    capacity_ *= 2;
  } else if (filled_ > 0) {
    std::memmove(window_.get(), window_.get() + position_, filled_);
  }
  position_ = 0;
  char* const free_space = window_.get() + filled_;
  const std::size_t count = std::min(capacity_ - filled_, end_ - unread_);
  if (std::fread(free_space, 1, count, handle_.get()) != count) {
    throw error(0, "cannot be read completely");
  }
  if (const void* nul = std::memchr(free_space, '\0', count)) {
    const auto offset = static_cast<std::size_t>(static_cast<const char*>(nul) - free_space);
    throw error(
        0,
        "is binary (NUL at byte " + std::to_string(unread_ + offset) + "), expected a text file");
  }
  filled_ += count;
  unread_ += count;
}

bool TextFile::next(Line& line) {
  std::size_t searched = 0;  // number of bytes after position_ without a newline
  while (position_ < filled_ || unread_ < end_) {
    const char* const begin = window_.get() + position_;
    const std::size_t left = filled_ - position_;
    const auto* const newline =
        static_cast<const char*>(std::memchr(begin + searched, '\n', left - searched));
    if (newline == nullptr && unread_ < end_) {
      searched = left;
      refill();
      continue;
    }
    searched = 0;
    const char* end = newline != nullptr ? newline : begin + left;
    position_ += static_cast<std::size_t>(end - begin) + (newline != nullptr ? 1 : 0);
    ++line_;
    if (end != begin && end[-1] == '\r') --end;
    const char* first = begin;
    while (first != end && (*first == ' ' || *first == '\t')) ++first;
    if (first == end || *first == '#') continue;
    line.text = {first, static_cast<std::size_t>(end - first)};
    line.number = line_;
    line.unterminated = newline == nullptr;
    return true;
  }
  return false;
}

void TextFile::put_back(const Line& line) {
  position_ = static_cast<std::size_t>(line.text.data() - window_.get());
  line_ = line.number - 1;
}

std::vector<TextFile> TextFile::cut(std::size_t count) const {
  std::vector<TextFile> out;
  std::size_t begin = 0;
  for (std::size_t k = 1; k <= count && begin < size_; ++k) {
    std::size_t end = size_;
    if (k < count) {
      // Reading one line from an arbitrary offset ends at the start of a line.
      TextFile rest(name_, size_, std::max(begin, size_ / count * k), size_);
      if (Line line; rest.next(line)) end = rest.unread_ - rest.filled_ + rest.position_;
    }
    out.push_back(TextFile(name_, size_, begin, end));
    begin = end;
  }
  return out;
}

}  // namespace loopbench
