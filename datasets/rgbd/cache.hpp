/// What was worked out before, kept in files that are whole or not there.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace loopbench {

/// Numbers, texts and lists of numbers, one after the other.
class Pack {
 public:
  template <class Number>
  requires std::is_trivially_copyable_v<Number>
  void put(const Number& value) { put_bytes(&value, sizeof value); }

  template <class Number>
  requires std::is_trivially_copyable_v<Number>
  void put(const std::vector<Number>& values) {
    put(values.size());
    put_bytes(values.data(), values.size() * sizeof(Number));
  }

  void put(const std::string& text) {
    put(text.size());
    put_bytes(text.data(), text.size());
  }

  const std::string& bytes() const { return bytes_; }

 private:
  void put_bytes(const void* data, std::size_t count) {
    bytes_.append(static_cast<const char*>(data), count);
  }
  std::string bytes_;
};

/// Reads back what was put, in the same order. Throws std::runtime_error past the end.
class Unpack {
 public:
  explicit Unpack(const std::string& bytes) : bytes_(bytes) {}

  template <class Number>
  requires std::is_trivially_copyable_v<Number>
  void get(Number& value) { std::memcpy(&value, take(sizeof value), sizeof value); }

  template <class Number>
  requires std::is_trivially_copyable_v<Number>
  void get(std::vector<Number>& values) {
    const std::size_t count = size(sizeof(Number));
    values.resize(count);
    if (count > 0) std::memcpy(values.data(), take(count * sizeof(Number)), count * sizeof(Number));
  }

  void get(std::string& text) {
    const std::size_t count = size(1);
    text.assign(take(count), count);
  }

 private:
  const char* take(std::size_t count) {
    if (count > bytes_.size() - at_) throw std::runtime_error("cache: file ends too early");
    at_ += count;
    return bytes_.data() + at_ - count;
  }
  std::size_t size(std::size_t unit) {
    std::size_t count = 0;
    get(count);
    if (count > (bytes_.size() - at_) / unit) throw std::runtime_error("cache: list too long");
    return count;
  }

  const std::string& bytes_;
  std::size_t at_ = 0;
};

/// The bytes kept in `file`; nothing when it is not there, cut off or changed.
std::optional<std::string> load_cached(const std::filesystem::path& file);

/// Writes beside and renames, so that a run that is killed leaves no half a file. What cannot be
/// written (a full or read-only disk) is not kept, and that is all.
void store_cached(const std::filesystem::path& file, const std::string& bytes);

/// Whoever holds it is the only one at work on `file`, on this machine; others wait. What cannot be
/// locked is not: then the same may be worked out twice, to the same bits.
class CacheLock {
 public:
  explicit CacheLock(const std::filesystem::path& file);
  ~CacheLock();
  CacheLock(const CacheLock&) = delete;
  CacheLock& operator=(const CacheLock&) = delete;

 private:
  int handle_;
};

/// `folder / stage-KEY`, KEY in hexadecimal.
std::filesystem::path cached_path(const std::filesystem::path& folder,
                                  const std::string& stage,
                                  std::uint64_t key);

}  // namespace loopbench
