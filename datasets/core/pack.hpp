/// Binary serialisation, for readers that are the same program: messages between its processes.
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

/// `walk(archive, value)` lists the members of T. Types with a bool need it, because not every byte
/// is a valid bool; other trivially copyable types do not, and are copied as bytes.
template <class T, class Archive>
concept Walked = requires(Archive& archive, T& value) {
  walk(archive, value);
};

/// Whether values of T are copied as bytes. Specialise it for types without pointers and padding
/// whose members have copy constructors of their own, as Eigen's.
template <class T>
inline constexpr bool kIsPlain = std::is_trivially_copyable_v<T>;

/// Appends its arguments: numbers, plain data, strings, vectors, optionals, and Walked types.
class Packer {
 public:
  template <class T>
  Packer& operator()(const T& value) {
    if constexpr (Walked<const T, Packer>) {
      walk(*this, value);
    } else {
      static_assert(kIsPlain<T>);
      bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    return *this;
  }
  template <class T>
  Packer& operator()(const std::optional<T>& value) {
    (*this)(value.has_value());
    return value ? (*this)(*value) : *this;
  }
  Packer& operator()(const std::string& text) {
    (*this)(text.size());
    bytes_ += text;
    return *this;
  }
  template <class T>
  Packer& operator()(const std::vector<T>& items) {
    (*this)(items.size());
    if constexpr (kIsPlain<T> && !Walked<const T, Packer>) {
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
/// early or contain an invalid bool, and allocates no more than they justify.
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : bytes_(bytes) {}

  template <class T>
  Unpacker& operator()(T& value) {
    if constexpr (Walked<T, Unpacker>) {
      walk(*this, value);
    } else {
      static_assert(kIsPlain<T>);
      std::memcpy(static_cast<void*>(&value), take(sizeof value), sizeof value);
    }
    return *this;
  }
  Unpacker& operator()(bool& value) {
    const char byte = *take(sizeof value);
    if (byte != 0 && byte != 1) throw std::runtime_error("serialised data are damaged");
    value = byte == 1;
    return *this;
  }
  template <class T>
  Unpacker& operator()(std::optional<T>& value) {
    bool any = false;
    (*this)(any);
    if (!any) value.reset();
    return any ? (*this)(value.emplace()) : *this;
  }
  Unpacker& operator()(std::string& text) {
    const std::size_t size = count(1);
    text.assign(take(size), size);
    return *this;
  }
  template <class T>
  Unpacker& operator()(std::vector<T>& items) {
    if constexpr (kIsPlain<T> && !Walked<T, Unpacker>) {
      items.resize(count(sizeof(T)));
      if (items.empty()) return *this;
      const std::size_t size = items.size() * sizeof(T);
      std::memcpy(static_cast<void*>(items.data()), take(size), size);
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
