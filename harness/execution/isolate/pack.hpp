/// Binary serialisation for messages between two processes of the same program.
#pragma once

#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace loopbench::harness {

/// Appends its arguments: plain data, strings, vectors, optionals, and types with a
/// `walk(archive, value)`.
class Packer {
 public:
  template <class T>
  Packer& operator()(const T& value) {
    if constexpr (std::is_trivially_copyable_v<T>) {
      bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    } else {
      walk(*this, value);
    }
    return *this;
  }
  Packer& operator()(const std::string& text) {
    (*this)(text.size());
    bytes_ += text;
    return *this;
  }
  template <class T>
  Packer& operator()(const std::vector<T>& items) {
    (*this)(items.size());
    if constexpr (std::is_trivially_copyable_v<T>) {
      bytes_.append(reinterpret_cast<const char*>(items.data()), items.size() * sizeof(T));
    } else {
      for (const T& item : items) (*this)(item);
    }
    return *this;
  }

  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Reads in the same order. Throws std::runtime_error if the bytes end too early, because a worker
/// with corrupted memory can send anything.
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : bytes_(bytes) {}

  template <class T>
  Unpacker& operator()(T& value) {
    if constexpr (std::is_trivially_copyable_v<T>) {
      std::memcpy(&value, take(sizeof value), sizeof value);
    } else {
      walk(*this, value);
    }
    return *this;
  }
  Unpacker& operator()(std::string& text) {
    const std::size_t size = count(1);
    text.assign(take(size), size);
    return *this;
  }
  template <class T>
  Unpacker& operator()(std::vector<T>& items) {
    if constexpr (std::is_trivially_copyable_v<T>) {
      items.resize(count(sizeof(T)));
      if (items.empty()) return *this;
      std::memcpy(items.data(), take(items.size() * sizeof(T)), items.size() * sizeof(T));
    } else {
      items.resize(count(1));
      for (T& item : items) (*this)(item);
    }
    return *this;
  }

 private:
  const char* take(std::size_t size) {
    if (size > bytes_.size()) throw std::runtime_error("a message of a worker is truncated");
    const char* out = bytes_.data();
    bytes_.remove_prefix(size);
    return out;
  }
  std::size_t count(std::size_t item_size) {
    std::size_t out = 0;
    std::memcpy(&out, take(sizeof out), sizeof out);
    if (out > bytes_.size() / item_size)
      throw std::runtime_error("a message of a worker is truncated");
    return out;
  }

  std::string_view bytes_;
};

}  // namespace loopbench::harness
