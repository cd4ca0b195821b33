/// Shared memory in which a cell leaves its result for its worker.
#pragma once

#include <sys/mman.h>
#include <sys/types.h>
#include <unistd.h>

#include <cstddef>
#include <cstring>
#include <new>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "harness/base/hash.hpp"

namespace loopbench::harness {

/// Created by the worker, inherited by its cells. Needs no descriptor that a method could close,
/// and a method that writes into it only loses its own result.
class ResultArea {
 public:
  ResultArea();  ///< throws std::runtime_error if it cannot be mapped
  ~ResultArea();
  ResultArea(const ResultArea&) = delete;
  ResultArea& operator=(const ResultArea&) = delete;

  /// Before a cell is forked.
  void clear();

  /// False if there are too many bytes.
  bool write(std::string_view bytes);

  /// nullopt unless `writer` wrote a complete result, which is unchanged. Valid until clear().
  std::optional<std::string_view> read(pid_t writer) const;

 private:
  struct Header;

  Header* header_ = nullptr;
};

inline constexpr std::size_t kCapacity = std::size_t{256}
                                         << 20;             // [bytes], used only as far as written
inline constexpr std::size_t kKept = std::size_t{1} << 20;  // [bytes], not returned to the system

struct ResultArea::Header {
  std::size_t size = 0;
  Hash hash;
  pid_t writer = 0;

  char* bytes() { return reinterpret_cast<char*>(this + 1); }
};

inline ResultArea::ResultArea() {
  constexpr int kFlags = MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE;
  void* memory = mmap(nullptr, kCapacity, PROT_READ | PROT_WRITE, kFlags, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("cannot map the memory for results");
  header_ = new (memory) Header;
}

inline ResultArea::~ResultArea() { munmap(header_, kCapacity); }

inline void ResultArea::clear() {
  if (header_->size == 0 || header_->size > kKept) {  // after a failure it can have been filled
    madvise(reinterpret_cast<char*>(header_) + kKept, kCapacity - kKept, MADV_REMOVE);
  }
  *header_ = {};
}

inline bool ResultArea::write(std::string_view bytes) {
  if (bytes.size() > kCapacity - sizeof(Header)) return false;
  std::memcpy(header_->bytes(), bytes.data(), bytes.size());
  header_->hash = hash_of(bytes);
  header_->writer = getpid();
  header_->size = bytes.size();
  return true;
}

inline std::optional<std::string_view> ResultArea::read(pid_t writer) const {
  const std::size_t size = header_->size;
  if (header_->writer != writer || size == 0 || size > kCapacity - sizeof(Header))
    return std::nullopt;
  const std::string_view bytes(header_->bytes(), size);
  if (hash_of(bytes) != header_->hash) return std::nullopt;
  return bytes;
}

}  // namespace loopbench::harness
