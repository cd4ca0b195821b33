/// A text that is kept once for all its copies.
#pragma once

#include <compare>
#include <concepts>
#include <iosfwd>
#include <string>
#include <string_view>

namespace loopbench::harness {

/// Copies and equality cost as much as those of a pointer: for the names that millions of scores
/// share. A text is kept until the program ends. Thread-safe; construction from other texts is
/// O(size).
class SharedText {
 public:
  SharedText() : text_(&empty_text()) {}
  SharedText(std::string_view text);  // NOLINT(google-explicit-constructor): is a text
  SharedText(const std::string& text) : SharedText(std::string_view(text)) {}  // NOLINT
  SharedText(const char* text) : SharedText(std::string_view(text)) {}         // NOLINT

  const std::string& text() const { return *text_; }
  operator const std::string&() const { return *text_; }  // NOLINT(google-explicit-constructor)
  bool empty() const { return text_->empty(); }
  void clear() { text_ = &empty_text(); }

  /// Equal for equal texts only.
  const void* id() const { return text_; }

  friend bool operator==(const SharedText& a, const SharedText& b) { return a.text_ == b.text_; }
  friend std::strong_ordering operator<=>(const SharedText& a, const SharedText& b) {
    return a.text_ == b.text_ ? std::strong_ordering::equal : *a.text_ <=> *b.text_;
  }
  template <std::convertible_to<std::string_view> Text>
  friend bool operator==(const SharedText& a, const Text& b) {
    return *a.text_ == std::string_view(b);
  }

  friend std::string operator+(const SharedText& a, std::string_view b) {
    return std::string(*a.text_).append(b);
  }
  friend std::string operator+(std::string a, const SharedText& b) { return a.append(*b.text_); }
  friend std::ostream& operator<<(std::ostream& out, const SharedText& text);

 private:
  static const std::string& empty_text();

  const std::string* text_;
};

}  // namespace loopbench::harness
