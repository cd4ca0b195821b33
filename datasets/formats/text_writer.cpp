#include "datasets/formats/text_writer.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>

#include "datasets/core/error.hpp"
#include "datasets/formats/replace_file.hpp"

namespace loopbench {

void TextWriter::separate() {
  if (!text_.empty() && text_.back() != '\n') text_ += separator_;
}

void TextWriter::comment(std::string_view text) {
  while (true) {
    const std::size_t end = text.find('\n');
    text_.append("# ").append(text.substr(0, end)).push_back('\n');
    if (end == std::string_view::npos) return;
    text.remove_prefix(end + 1);
  }
}

TextWriter& TextWriter::word(std::string_view text) {
  separate();
  text_ += text;
  return *this;
}

TextWriter& TextWriter::number(double value) {
  separate();
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text_.append(digits.data(), end);
  return *this;
}

TextWriter& TextWriter::integer(std::int64_t value) {
  separate();
  text_ += std::to_string(value);
  return *this;
}

void TextWriter::end_line() { text_ += '\n'; }

void TextWriter::row(std::initializer_list<double> values) {
  for (const double value : values) number(value);
  end_line();
}

void TextWriter::save(const std::filesystem::path& file) const {
  if (file != "-") return replace_file(file, text_, Target::named);
  if (std::fwrite(text_.data(), 1, text_.size(), stdout) != text_.size()) {
    throw input_error("-", 0, std::string("cannot be written: ") + std::strerror(errno));
  }
}

}  // namespace loopbench
