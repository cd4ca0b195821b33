/// File cache of intermediate results, with atomic writes and checksums.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace loopbench::rgbd {

/// Binary serialisation of numbers, strings and vectors of numbers.
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

/// Deserialisation in the order of serialisation. Throws std::runtime_error past the end.
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
    if (count > bytes_.size() - at_) throw std::runtime_error("cache: unexpected end of file");
    at_ += count;
    return bytes_.data() + at_ - count;
  }
  std::size_t size(std::size_t item_bytes) {
    std::size_t count = 0;
    get(count);
    if (count > (bytes_.size() - at_) / item_bytes)
      throw std::runtime_error("cache: list length exceeds the file size");
    return count;
  }

  const std::string& bytes_;
  std::size_t at_ = 0;
};

/// Returns the bytes stored in `file`, or nothing if it is missing, truncated or corrupt.
std::optional<std::string> load_cached(const std::filesystem::path& file);

/// Writes to a temporary file and renames it, so that an interrupted run leaves no partial file.
/// Write errors (full or read-only disk) are ignored.
void store_cached(const std::filesystem::path& file, const std::string& bytes);

/// Exclusive lock for work on `file` between processes of one machine; blocks until it is acquired.
/// If locking fails, work may be done twice with bit-identical results.
class CacheLock {
 public:
  explicit CacheLock(const std::filesystem::path& file);
  ~CacheLock();
  CacheLock(const CacheLock&) = delete;
  CacheLock& operator=(const CacheLock&) = delete;

 private:
  int handle_;
};

/// Path `folder / stage-KEY`, with KEY in hexadecimal.
std::filesystem::path cached_path(const std::filesystem::path& folder,
                                  const std::string& stage,
                                  std::uint64_t key);

}  // namespace loopbench::rgbd
