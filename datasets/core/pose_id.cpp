#include "datasets/core/pose_id.hpp"

#include <charconv>

namespace loopbench {
namespace {

bool is_letter(std::int64_t c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

constexpr std::int64_t kEndOfIndices = std::int64_t{1} << kSymbolBits;

}  // namespace

bool is_symbol(std::int64_t id) { return is_letter(id >> kSymbolBits); }

std::string id_text(std::int64_t id) {
  if (!is_symbol(id)) return std::to_string(id);
  return static_cast<char>(id >> kSymbolBits) + std::to_string(id & (kEndOfIndices - 1));
}

std::optional<std::int64_t> id_of(std::string_view text) {
  const bool has_letter = !text.empty() && is_letter(text.front());
  const std::string_view digits = text.substr(has_letter ? 1 : 0);
  std::int64_t out = 0;
  const char* const end = digits.data() + digits.size();
  const auto [rest, error] = std::from_chars(digits.data(), end, out);
  if (error != std::errc{} || rest != end) return std::nullopt;
  if (!has_letter) return out;
  if (out < 0 || out >= kEndOfIndices) return std::nullopt;
  return (std::int64_t{text.front()} << kSymbolBits) + out;
}

}  // namespace loopbench
