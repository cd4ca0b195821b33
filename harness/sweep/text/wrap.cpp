#include "harness/sweep/text/wrap.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>

namespace loopbench::harness {
namespace {

bool is_continuation_byte(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

/// The first `count` code points.
std::string first_characters(const std::string& text, std::size_t count) {
  std::size_t end = 0;
  for (; end < text.size(); ++end) {
    if (is_continuation_byte(text[end])) continue;
    if (count == 0) break;
    --count;
  }
  return text.substr(0, end);
}

/// The last `count` code points.
std::string last_characters(const std::string& text, std::size_t count) {
  std::size_t begin = text.size();
  while (begin > 0 && count > 0) {
    --begin;
    if (!is_continuation_byte(text[begin])) --count;
  }
  return text.substr(begin);
}

bool is_unit(const std::string& word) {
  constexpr std::string_view kUnits = " % m km cm mm s min ms us ns deg rad Hz MB deg/m m/s ";
  const std::string plain = word.substr(0, word.find_last_not_of(".,;:)") + 1);
  return !plain.empty() && kUnits.find(" " + plain + " ") != std::string_view::npos;
}

}  // namespace

std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return !is_continuation_byte(c); }));
}

std::vector<std::string> wrapped(const std::string& text, std::size_t columns) {
  if (columns == 0 || width(text) <= columns) return {text};
  std::vector<std::string> out;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!out.empty() && width(out.back()) + 1 + width(word) <= columns) {
      out.back() += " " + word;
    } else if (!out.empty() && is_unit(word) &&
               std::isdigit(static_cast<unsigned char>(out.back().back())) != 0 &&
               out.back().find(' ') != std::string::npos) {
      const std::size_t space = out.back().rfind(' ');
      const std::string number = out.back().substr(space + 1);
      out.back().resize(space);
      out.push_back(number + " " + word);
    } else {
      out.push_back(word);
    }
  }
  return out;
}

std::string beside(const std::string& name,
                   const std::string& text,
                   std::size_t begin,
                   std::size_t columns) {
  const std::string margin(begin, ' ');
  const bool fits = width(name) + 2 <= begin;
  std::string out = name + (fits ? margin.substr(width(name)) : "\n" + margin);
  std::size_t count = 0;
  for (const std::string& line : wrapped(text, columns == 0 ? 0 : columns - begin)) {
    out += (count++ == 0 ? "" : "\n" + margin) + line;
  }
  out.erase(out.find_last_not_of(" \n") + 1);
  return out + "\n";
}

std::string shortened(const std::string& text, std::size_t columns) {
  if (width(text) <= columns) return text;
  constexpr const char* kEllipsis = "\u2026";
  if (text.find('/') != std::string::npos) {
    // From a slash on, if enough of the path remains.
    const std::string end = last_characters(text, columns - 1);
    const std::size_t slash = end.find('/');
    return kEllipsis + (slash == std::string::npos ? end : end.substr(slash));
  }
  const std::size_t back = (columns - 1) / 2;
  return first_characters(text, columns - 1 - back) + kEllipsis + last_characters(text, back);
}

std::string cut(const std::string& text, std::size_t columns) {
  if (width(text) <= columns) return text;
  return first_characters(text, columns - 1) + "\u2026";
}

}  // namespace loopbench::harness
