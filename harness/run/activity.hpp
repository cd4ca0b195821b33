/// What the process of a cell is doing, for the reason that its worker gives if it ends early.
#pragma once

#include <sys/mman.h>

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>

#include "harness/base/printable.hpp"

namespace loopbench::harness {

/// States a text until destroyed, in memory that a worker shares with the processes it forks; does
/// nothing before share(). One at a time.
class Activity {
 public:
  /// In the worker, before it forks; further calls have no effect. Throws std::runtime_error if no
  /// memory can be mapped.
  static void share() {
    if (text_ != nullptr) return;
    constexpr int kFlags = MAP_SHARED | MAP_ANONYMOUS;
    void* memory = mmap(nullptr, sizeof(Text), PROT_READ | PROT_WRITE, kFlags, -1, 0);
    if (memory == MAP_FAILED) throw std::runtime_error("cannot map the memory for activities");
    text_ = new (memory) Text{};
  }

  /// Printable, since a method can have written there; "" if nothing is stated.
  static std::string current() {
    if (text_ == nullptr) return "";
    return printable({text_->bytes, std::min(text_->size, kMost)});
  }

  static void clear() {
    if (text_ != nullptr) text_->size = 0;
  }

  explicit Activity(std::string_view text) {
    if (text_ == nullptr) return;
    const std::string_view kept = beginning(text, kMost);
    std::ranges::copy(kept, text_->bytes);
    text_->size = kept.size();
  }
  ~Activity() { clear(); }
  Activity(const Activity&) = delete;
  Activity& operator=(const Activity&) = delete;

 private:
  static constexpr std::size_t kMost = 200;  // [bytes]

  struct Text {
    std::size_t size = 0;
    char bytes[kMost] = {};
  };

  inline static Text* text_ = nullptr;
};

}  // namespace loopbench::harness
