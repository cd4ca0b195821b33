/// Binary serialisation, for readers that are the same program: messages and caches.
#pragma once

#include <concepts>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace loopbench {

/// T is Of, for reading or const for writing.
template <class T, class Of>
concept Either = std::same_as<std::remove_const_t<T>, Of>;

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

/// Reads in the same order. The bytes may be anything: throws std::runtime_error if they end too
/// early, and allocates no more than they justify.
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
      items.clear();
      for (std::size_t left = count(1); left > 0; --left) (*this)(items.emplace_back());
    }
    return *this;
  }

 private:
  const char* take(std::size_t size) {
    if (size > bytes_.size()) throw std::runtime_error("serialised data are truncated");
    const char* out = bytes_.data();
    bytes_.remove_prefix(size);
    return out;
  }
  std::size_t count(std::size_t item_size) {
    std::size_t out = 0;
    std::memcpy(&out, take(sizeof out), sizeof out);
    if (out > bytes_.size() / item_size) throw std::runtime_error("serialised data are truncated");
    return out;
  }

  std::string_view bytes_;
};

}  // namespace loopbench
