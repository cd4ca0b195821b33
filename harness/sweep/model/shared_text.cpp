#include "harness/sweep/model/shared_text.hpp"

#include <functional>
#include <mutex>
#include <ostream>
#include <unordered_set>

namespace loopbench::harness {
namespace {

struct TextHash {
  using is_transparent = void;
  std::size_t operator()(std::string_view text) const {
    return std::hash<std::string_view>{}(text);
  }
};

/// Never destroyed: static objects may hold texts.
struct TextPool {
  std::mutex mutex;
  std::unordered_set<std::string, TextHash, std::equal_to<>> texts;  // stable addresses
};

TextPool& text_pool() {
  static TextPool* const pool = new TextPool;
  return *pool;
}

}  // namespace

SharedText::SharedText(std::string_view text) : text_(&empty_text()) {
  if (text.empty()) return;
  TextPool& pool = text_pool();
  const std::scoped_lock lock(pool.mutex);
  const auto found = pool.texts.find(text);
  text_ = found != pool.texts.end() ? &*found : &*pool.texts.emplace(text).first;
}

std::ostream& operator<<(std::ostream& out, const SharedText& text) { return out << text.text(); }

const std::string& SharedText::empty_text() {
  static const std::string empty;
  return empty;
}

}  // namespace loopbench::harness
