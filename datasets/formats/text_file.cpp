#include "datasets/formats/text_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

namespace loopbench {
namespace {

constexpr std::size_t kLargest = std::size_t{8} << 30;  // [bytes]; 1e6 poses are 0.1 GB
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

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
    throw input_error(name, 0, "is not a plain file, expected a text file");
  }
  const auto size = std::filesystem::file_size(file, error);
  if (error) throw input_error(name, 0, "cannot be read: " + error.message());
  if (size == 0) throw input_error(name, 0, "is empty");
  if (size > kLargest) {
    throw input_error(
        name,
        0,
        "has " + std::to_string(size) + " bytes, expected at most " + std::to_string(kLargest));
  }
  return static_cast<std::size_t>(size);
}

}  // namespace

TextFile::TextFile(const std::filesystem::path& file)
    : name_(file.string()), size_(size_of_plain_file(file, name_)) {
  const std::unique_ptr<std::FILE, Close> handle(std::fopen(name_.c_str(), "rb"));
  if (!handle) throw input_error(name_, 0, std::string("cannot be read: ") + std::strerror(errno));
  content_ = std::make_unique_for_overwrite<char[]>(size_);
  if (std::fread(content_.get(), 1, size_, handle.get()) != size_) {
    throw input_error(name_, 0, "cannot be read to its end");
  }
  if (const void* nul = std::memchr(content_.get(), '\0', size_)) {
    const auto offset = static_cast<const char*>(nul) - content_.get();
    throw input_error(
        name_, 0, "is binary (NUL at byte " + std::to_string(offset) + "), expected a text file");
  }
  rewind();
}

void TextFile::rewind() {
  line_ = 0;
  const std::string_view text(content_.get(), size_);
  position_ = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
}

bool TextFile::next(Line& line) {
  while (position_ < size_) {
    const char* const begin = content_.get() + position_;
    const std::size_t left = size_ - position_;
    const auto* const newline = static_cast<const char*>(std::memchr(begin, '\n', left));
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

}  // namespace loopbench
