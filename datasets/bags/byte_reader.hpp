/// Little-endian or big-endian values from a byte string, with bounds checks.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

namespace loopbench {

/// A record that ends early or contradicts itself.
class DamagedRecord final : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  std::size_t left() const { return bytes_.size() - at_; }
  std::size_t position() const { return at_; }
  void set_big_endian(bool is_big) { is_big_ = is_big; }

  template <class T>
  T number() {
    T out{};
    char raw[sizeof(T)];
    std::memcpy(raw, bytes(sizeof(T)).data(), sizeof(T));
    if (is_big_) {
      for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(raw[i], raw[sizeof(T) - 1 - i]);
    }
    std::memcpy(&out, raw, sizeof(T));
    return out;
  }

  std::string_view bytes(std::uint64_t count) {
    if (count > left()) throw DamagedRecord("ends early");
    const std::string_view out = bytes_.substr(at_, static_cast<std::size_t>(count));
    at_ += out.size();
    return out;
  }

  /// A byte string preceded by its length in 32 bits.
  std::string_view counted() { return bytes(number<std::uint32_t>()); }

 private:
  static_assert(std::endian::native == std::endian::little);
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool is_big_ = false;
};

}  // namespace loopbench
