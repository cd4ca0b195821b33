/// Bytes of a bag: values from a byte string with bounds checks, and a file read through a window.
#pragma once

#include <sys/types.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "datasets/compressed/input_file.hpp"

namespace loopbench {

/// A record that ends early or contradicts itself.
class DamagedRecord final : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads little-endian or big-endian values.
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

/// A file read through a window.
class BagSource {
 public:
  explicit BagSource(const OpenedFile& file)
      : file_(file), size_(file.size), handle_(std::fopen(file.path.c_str(), "rb")) {
    if (!handle_) throw file_.error(std::string("cannot be read: ") + std::strerror(errno));
    std::setvbuf(handle_.get(), nullptr, _IONBF, 0);
  }

  std::uint64_t size() const { return size_; }

  /// Bytes [at, at + count), valid until the next call. Throws DamagedRecord if the file ends
  /// before, InputError if it cannot be read.
  std::string_view bytes(std::uint64_t at, std::uint64_t count) {
    constexpr std::uint64_t kWindow = std::uint64_t{64} << 10;  // [bytes]
    if (at > size_ || count > size_ - at) throw DamagedRecord("ends early");
    if (at < begin_ || at + count > begin_ + window_.size()) {
      window_.resize(static_cast<std::size_t>(std::min(std::max(count, kWindow), size_ - at)));
      begin_ = at;
      const bool is_read =
          fseeko(handle_.get(), static_cast<off_t>(at), SEEK_SET) == 0 &&
          std::fread(window_.data(), 1, window_.size(), handle_.get()) == window_.size();
      if (!is_read) {
        window_.clear();
        throw file_.error("cannot be read completely");
      }
    }
    return std::string_view(window_).substr(static_cast<std::size_t>(at - begin_),
                                            static_cast<std::size_t>(count));
  }

 private:
  struct CloseHandle {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  OpenedFile file_;
  std::uint64_t size_ = 0;
  std::unique_ptr<std::FILE, CloseHandle> handle_;
  std::uint64_t begin_ = 0;  ///< file offset of the window
  std::string window_;
};

}  // namespace loopbench
