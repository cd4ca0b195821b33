#include "datasets/columns/text_file.hpp"

#include <sys/types.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <limits>
#include <system_error>

namespace loopbench {
namespace {

constexpr std::size_t kWindow = std::size_t{256} << 10;     // [bytes], fits into the L2 cache
constexpr std::size_t kLongestLine = std::size_t{1} << 20;  // [bytes]
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool is_number(std::string_view word) {
  double value = 0.0;
  const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc{} && rest == word.data() + word.size();
}

/// The words of a line, separated by blanks, tabs or commas, without quotes.
std::vector<std::string_view> words_of(std::string_view text) {
  constexpr std::string_view kSeparators = " \t,\"";
  std::vector<std::string_view> out;
  while (true) {
    const std::size_t first = text.find_first_not_of(kSeparators);
    if (first == text.npos) return out;
    text.remove_prefix(first);
    const std::size_t end = std::min(text.find_first_of(kSeparators), text.size());
    out.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
}

bool names_columns(std::string_view text) {
  constexpr std::size_t kFewest = 3;
  const std::vector<std::string_view> words = words_of(text);
  // `rostopic echo -p` starts its header with %, PlotJuggler with __time.
  const bool starts_with_letter =
      !words.empty() && (std::isalpha(static_cast<unsigned char>(words[0][0])) != 0 ||
                         words[0][0] == '%' || words[0].starts_with("__"));
  // A number that is not finite is an invalid pose, not a name.
  return starts_with_letter && words.size() >= kFewest && std::ranges::none_of(words, is_number);
}

}  // namespace

TextFile::TextFile(const std::filesystem::path& file)
    : TextFile(open_input(file), 0, std::numeric_limits<std::size_t>::max()) {}

TextFile::TextFile(OpenedFile file, std::size_t begin, std::size_t end)
    : file_(std::move(file)),
      begin_(begin),
      unread_(begin),
      end_(std::min(file_.size, end)),
      capacity_(std::min(kWindow, end_ - begin)),
      handle_(std::fopen(file_.path.c_str(), "rb")) {
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

TextFile TextFile::part(std::size_t begin, std::size_t end) const {
  TextFile out(file_, begin, end);
  out.header_ = header_;
  out.comment_ = comment_;
  out.settings_ = settings_;
  out.is_first_ = is_first_ && begin == begin_;
  return out;
}

void TextFile::skip_header() {
  TextFile probe = reopened();
  probe.keeps_comment_ = true;
  Line line;
  if (!probe.next(line)) return;
  comment_ = probe.comment_;
  settings_ = std::move(probe.settings_);
  if (!names_columns(line.text)) return;
  std::string header(line.text);
  const std::size_t end = probe.offset();
  if (!probe.next(line)) return;
  const std::vector<std::string_view> words = words_of(line.text);
  constexpr std::ptrdiff_t kFewestNumbers = 4;  // a stamp, or none, and a position
  const bool is_row = !words.empty() && is_number(words[0]);
  if (!is_row && std::ranges::count_if(words, is_number) < kFewestNumbers) return;
  next(line);
  header_ = std::move(header);
  begin_ = end;
}

/// Reads the next bytes into the window. Drops the lines already read, or doubles the window if a
/// single line fills it.
void TextFile::refill() {
  filled_ -= position_;
  if (filled_ == capacity_) {
    if (filled_ >= kLongestLine) {
      throw error(begin_ == 0 ? line_ + 1 : 0, "has a line of more than 1 MiB, expected poses");
    }
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
    if (first == end) continue;
    if (*first == '#') {
      if (keeps_comment_) comment_.assign(first + 1, end);
      if (keeps_comment_ && comment_.starts_with('%')) {
        settings_.emplace_back(line_, comment_.substr(1));
      }
      continue;
    }
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

Line first_line(TextFile& file) {
  Line line;
  if (!file.next(line)) throw file.error(0, "contains no data, only comments and blank lines");
  file.put_back(line);
  return line;
}

std::vector<TextFile> TextFile::cut(std::size_t count) const {
  std::vector<TextFile> out;
  std::size_t begin = begin_;
  for (std::size_t k = 1; k <= count && begin < end_; ++k) {
    std::size_t end = end_;
    if (k < count) {
      // Reading one line from an arbitrary offset ends at the start of a line.
      TextFile rest = part(std::max(begin, end_ / count * k), end_);
      if (Line line; rest.next(line)) end = rest.offset();
    }
    out.push_back(part(begin, end));
    begin = end;
  }
  return out;
}

}  // namespace loopbench
